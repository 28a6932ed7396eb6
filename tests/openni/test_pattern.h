// The pattern that the test driver's devices show when they play no folder. The driver and the
// tests both know every pixel of it.
#pragma once

#include <cstdint>

namespace tessera::test_device {

constexpr int kWidth = 640, kHeight = 480;
constexpr double kFocal_px = 525;  // along x and y, which gives the device's fields of view
constexpr int kNearest_mm = 500;

// Depth in mm of frame `index`; 0 ("no measurement") in small blocks that move.
inline std::uint16_t PatternDepth(int index, int x, int y) {
    if ((x / 16 + y / 16 + index) % 29 == 0) return 0;
    return static_cast<std::uint16_t>(kNearest_mm + (x * 7 + y * 13 + index * 31) % 6000);
}

// Channels 0, 1, 2 are r, g, b. Smooth, so that JPEG compression changes little.
inline std::uint8_t PatternColour(int index, int x, int y, int channel) {
    return static_cast<std::uint8_t>((x / 4 + y / 4 * (channel + 1) / 2 + index) % 200 + 20);
}

}  // namespace tessera::test_device
