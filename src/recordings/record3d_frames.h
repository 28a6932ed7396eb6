// The frames of a Record3D recording: which files of the archive they are, when they were taken
// and how large their depth is.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "io/image_header.h"
#include "recordings/recording.h"
#include "recordings/zip_file.h"

namespace tessera {

// Indices of files in the archive.
struct Record3dFrame {
    std::optional<std::size_t> image, depth, confidence;
    bool whole() const { return image && depth; }
};

// By the number in the files' names. Each has an image or depth.
using Record3dFrames = std::map<std::uint32_t, Record3dFrame>;

// "rgbd/12.jpg", "rgbd/12.depth", "rgbd/12.conf"; all other files are left out.
Record3dFrames FindRecord3dFrames(const ZipFile& archive);

// Of whole frames, with the metadata's stamps: one for each frame, or one for each number up to the
// largest. Empty if it is neither, or if they do not increase.
std::vector<RecordedPair> StampedRecord3dPairs(const Record3dFrames& frames,
                                               std::span<const double> stamps_s);

// Of whole frames; the first frame's stamp is 0.
std::vector<RecordedPair> EvenRecord3dPairs(const Record3dFrames& frames, double fps);

// Of a depth image that has so many bytes of 32-bit numbers: `said` if it fits, otherwise the
// colour images' shape. 0 x 0: neither is possible.
ImageSize Record3dDepthSize(ImageSize said, ImageSize colour, std::uint64_t bytes);

}  // namespace tessera
