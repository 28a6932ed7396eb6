// Records any source into a folder in TUM layout, which `tessera run FOLDER` and all other tools in
// this project can read.
//
//   rgb/STAMP.jpg (or .png)   depth/STAMP.png   rgb.txt   depth.txt   camera.yaml
//   groundtruth.txt, if the frames have ground truth
//
// Depth is 16-bit PNG in the source's own units, so reading it back gives exactly the same values.
// On one core, a 640x480 frame takes 4 to 6 ms with JPEG, 8 to 11 ms with PNG (recorded images).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/status.h"
#include "io/frame_source.h"
#include "io/growing_file.h"
#include "io/png_encoder.h"

namespace tessera {

struct RecordConfig {
    enum class Colour { kJpeg, kPng };
    Colour colour = Colour::kJpeg;

    void Describe(ConfigParameters& parameters);
};

// Owner thread only. After an error of writing, every further Add returns it.
class FrameRecorder {
  public:
    // Creates the folder. Refuses a source without colour, because folders are read with both
    // images, and a folder that already contains a recording or is not writable.
    static Result<std::unique_ptr<FrameRecorder>> Create(const std::string& folder,
                                                         const SourceInfo& source,
                                                         const RecordConfig& config = {});

    // Why the frame cannot be recorded, while others can: it has no colour, another size, or a
    // stamp that is not a microsecond later than that of the last one recorded. Empty if it can.
    std::string WhyNot(const Frame& frame) const;

    // Writes the frame before it returns. Images are written to a temporary file, renamed, and only
    // then listed. So at any time, even if the disk is full or the process is killed, the folder
    // holds a readable recording of the earlier frames. Errors name the file, what is wrong, and
    // how many frames are safe. A frame for which WhyNot has a reason is refused with it.
    Status Add(const Frame& frame);

    // Flushes everything to disk. Call it once, at the end.
    Status Finish();

    std::int64_t frames() const { return frames_; }

  private:
    FrameRecorder(const std::string& folder, const SourceInfo& source, const RecordConfig& config)
        : folder_(folder), source_(source), config_(config) {}
    Status Start();
    Status WriteImages(const Frame& frame, const std::string& colour_name,
                       const std::string& depth_name);
    Status List(const Frame& frame, const std::string& colour_name, const std::string& depth_name);
    Status WriteImage(const std::string& name) const;

    const std::string folder_;
    const SourceInfo source_;
    const RecordConfig config_;
    GrowingFile colour_list_, depth_list_, truth_;
    PngEncoder png_;
    Image<std::uint16_t> depth_;      // recycled storage, like file_
    std::vector<std::uint8_t> file_;  // an encoded image
    std::int64_t frames_ = 0;
    double last_stamp_s_ = 0, last_colour_stamp_s_ = 0;
    Status status_;  // the first error of writing
};

}  // namespace tessera
