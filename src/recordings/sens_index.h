// The header of a ScanNet .sens file and where its frames are, without their images. The format is
// that of github.com/ScanNet/ScanNet, SensReader, version 4.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/input_file.h"
#include "recordings/recording.h"

namespace tessera {

enum class SensColour : std::int32_t { kRaw = 0, kPng = 1, kJpeg = 2 };
enum class SensDepth : std::int32_t { kRaw = 0, kZlib = 1, kOcci = 2 };

// The colour bytes are at `offset`, the depth bytes follow.
struct SensFrame {
    std::uint64_t offset = 0;
    std::uint32_t colour_bytes = 0, depth_bytes = 0;
};

struct SensIndex {
    RecordingInfo info;  // one pair for each frame
    SensColour colour = SensColour::kJpeg;
    SensDepth depth = SensDepth::kZlib;
    bool has_colour = true;
    std::vector<SensFrame> frames;  // all within the file
};

// Errors name the file. What was cut off is a warning.
Result<SensIndex> ReadSensIndex(const InputFile& file);

}  // namespace tessera
