// What the test driver's devices show when they serve no folder: known to the driver and to the
// tests, pixel by pixel.
#pragma once

#include <cstdint>

namespace tessera::test_device {

constexpr int kWidth = 640, kHeight = 480;
constexpr double kFocal_px = 525;  // along x and y: what the device's fields of view amount to
constexpr int kNearest_mm = 500;

// Depth in mm of frame `index`; 0, "no measurement", in a small block that wanders.
inline std::uint16_t PatternDepth(int index, int x, int y) {
    if ((x / 16 + y / 16 + index) % 29 == 0) return 0;
    return static_cast<std::uint16_t>(kNearest_mm + (x * 7 + y * 13 + index * 31) % 6000);
}

// Channel 0, 1, 2 = r, g, b; smooth, so that JPEG changes little.
inline std::uint8_t PatternColour(int index, int x, int y, int channel) {
    return static_cast<std::uint8_t>((x / 4 + y / 4 * (channel + 1) / 2 + index) % 200 + 20);
}

}  // namespace tessera::test_device
