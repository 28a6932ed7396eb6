// The images in the recordings of these tests, which write_bag.py and ros2_writer.h write.
#pragma once

#include <cstdint>

#include "core/image.h"

namespace tessera::ros_test {

inline constexpr int kFrames = 5;
inline constexpr int kDepthWidth = 64, kDepthHeight = 48, kColourWidth = 96, kColourHeight = 72;

inline Image<std::uint16_t> DepthOf(int frame) {
    Image<std::uint16_t> depth(kDepthWidth, kDepthHeight);
    for (int y = 0; y < kDepthHeight; ++y)
        for (int x = 0; x < kDepthWidth; ++x)
            depth(x, y) = static_cast<std::uint16_t>(500 + 7 * x + 13 * y + 101 * frame);
    return depth;
}

inline ColourImage ColourOf(int frame) {
    const auto byte = [](int value) { return static_cast<std::uint8_t>(value % 256); };
    ColourImage colour(kColourWidth, kColourHeight);
    for (int y = 0; y < kColourHeight; ++y)
        for (int x = 0; x < kColourWidth; ++x)
            colour(x, y) = {byte(x * 2 + frame), byte(y * 3), byte(x + y + 17 * frame)};
    return colour;
}

inline double StampOf(int frame) { return 1000 + 0.1 * frame; }

}  // namespace tessera::ros_test
