// A libfreenect without hardware, for the test of the Kinect driver. Its cameras show a pattern at
// 30 Hz. Thread-safe.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tessera::fake_freenect {

void Plug(const std::string& serial);
// Its images end, and the events of an open camera fail.
void Unplug(const std::string& serial);
// Another program has it.
void Occupy(const std::string& serial);

int OpenCameras();
// What was called, in order: "open A1", "depth registered", "depth mm", "colour", "flag 65536 0",
// "stop depth", "stop colour", "close A1", "shutdown".
std::vector<std::string> Calls();

// Pixels of image `number`. The number of an image: its first depth in mm, less 1000; its first
// red.
inline std::uint16_t PatternDepth_mm(int number, int x, int y) {
    return static_cast<std::uint16_t>(1000 + number + (3 * x + 5 * y) % 2000);
}
inline std::uint8_t PatternColour(int number, int x, int y, int channel) {
    return static_cast<std::uint8_t>(number + x + 2 * y + 50 * channel);
}

}  // namespace tessera::fake_freenect
