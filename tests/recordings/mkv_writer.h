// Writes recordings like those of the Azure Kinect through the program ffmpeg, so that another
// program than ours decides what a Matroska file is.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"
#include "io/temporary_folder.h"

namespace tessera {

// Without it, tests skip.
bool HaveFfmpeg();

struct MkvRecipe {
    int depth_count = 6, colour_count = 6;  // 0: no such track
    int colour_late_ms = 5;                 // after depth
    std::string depth_name = "DEPTH", colour_name = "COLOR";
    std::vector<std::string> tags{"K4A_START_OFFSET_NS=100000000"};
    std::string calibration;  // text of calibration.json; empty: none
    bool streamed = false;    // without sizes and an index
};
inline constexpr int kMkvFrame_ms = 40;
inline constexpr int kMkvDepthWidth = 320, kMkvDepthHeight = 288;
inline constexpr int kMkvColourWidth = 1280, kMkvColourHeight = 720;

Image<std::uint16_t> MkvTestDepth(int index);
// The JPEG file of the image, as it is in the recording.
std::vector<std::uint8_t> MkvTestJpeg(int index);

// Writes `name` into the folder.
void WriteMkv(const TemporaryFolder& folder, const std::string& name, const MkvRecipe& recipe);

}  // namespace tessera
