// What a Matroska file contains and where its images are, without reading them. The index that such
// a file may have at its end is not used, so a recording that was cut off can be read.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/input_file.h"

namespace tessera {

// One image of a track. It is within the file.
struct MkvBlock {
    std::int64_t stamp_ns = 0;  // within 27 days of 0
    std::uint64_t offset = 0;   // of its bytes in the file
    std::uint32_t bytes = 0;    // at most kMostMkvBlockBytes
};
inline constexpr std::uint64_t kMostMkvBlockBytes = std::uint64_t{256} << 20;

struct MkvTrack {
    std::uint64_t number = 0, uid = 0;
    bool is_video = false;
    bool is_packed = false;  // its blocks are compressed or encrypted once more
    std::string name;        // "DEPTH"
    std::string format;      // of its images: "MJPG", "b16g", or Matroska's name of the codec
    std::uint64_t width = 0, height = 0;  // pixels
    double fps = 0;                       // 0: not said
    std::vector<MkvBlock> blocks;         // of video only; stamps increase
};

struct MkvAttachment {
    std::string name;
    std::uint64_t offset = 0;  // of its content in the file
    std::uint64_t bytes = 0;   // at most kMostMkvAttachmentBytes
};
inline constexpr std::uint64_t kMostMkvAttachmentBytes = 16 << 20;

struct MkvIndex {
    std::vector<MkvTrack> tracks;
    std::map<std::string, std::string> tags;  // by name, whatever they are attached to
    std::vector<MkvAttachment> attachments;
    std::vector<std::string> warnings;  // what is damaged, cut off or not read
};

// Reads the heads of all elements, which takes a few microseconds for each image. An error only if
// it is no Matroska file; names the file.
Result<MkvIndex> ReadMkvIndex(const InputFile& file);

}  // namespace tessera
