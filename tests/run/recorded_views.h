// Writes a recording in TUM's layout.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/frame.h"
#include "io/image_io.h"
#include "support/temp_folder.h"

namespace tessera {

// Frames a tenth of a second apart.
inline void WriteViews(const TempFolder& folder, const std::vector<Frame>& frames,
                       const CameraCalibration& camera) {
    for (const char* name : {"depth", "rgb"}) std::filesystem::create_directories(folder / name);
    std::ofstream depths(folder / "depth.txt"), colours(folder / "rgb.txt");
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const Frame& frame = frames[i];
        Image<std::uint16_t> stored(frame.depth_m.width(), frame.depth_m.height());
        std::transform(frame.depth_m.data(), frame.depth_m.data() + stored.size(), stored.data(),
                       [](float z_m) { return static_cast<std::uint16_t>(1000 * z_m); });
        const std::string number = std::to_string(i) + ".png";
        ASSERT_TRUE(WriteDepthImage(folder / ("depth/" + number), stored).ok());
        ASSERT_TRUE(WriteColourImage(folder / ("rgb/" + number), frame.colour).ok());
        depths << 0.1 * static_cast<double>(i) << " depth/" << number << '\n';
        colours << 0.1 * static_cast<double>(i) << " rgb/" << number << '\n';
    }
    std::ofstream(folder / "camera.yaml") << CameraFileText(camera);
}

}  // namespace tessera
