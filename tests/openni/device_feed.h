// The images shown by a device of the test driver: an endless sequence of numbered frames.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tessera::test_device {

struct FeedFrame {
    std::uint64_t stamp_us = 0;
    std::vector<std::uint16_t> depth_mm;  // width x height
    std::vector<std::uint8_t> rgb;        // 3 x width x height
};

class DeviceFeed {
  public:
    virtual ~DeviceFeed() = default;
    virtual int width() const = 0;
    virtual int height() const = 0;
    virtual double fx() const = 0;
    virtual double fy() const = 0;
    // Returns frame `number` >= 0. Stamps increase strictly with the number.
    virtual void Get(int number, FeedFrame& frame) = 0;
};

// The pattern of test_pattern.h at `rate_hz`. The first stamp is 1 s.
std::unique_ptr<DeviceFeed> MakePatternFeed(double rate_hz);

// Plays a TUM-layout folder (rgb.txt, depth.txt, camera.yaml) at its recorded pace, forwards and
// backwards so that the motion stays smooth: frames 0, 1, ..., n-1, n-2, ..., 1, 0, 1, ... Returns
// null, with a line on stderr, if the folder cannot be read. The first `preload` frames are decoded
// at once, the others each time they are shown.
std::unique_ptr<DeviceFeed> MakeFolderFeed(const std::string& folder, int preload);

}  // namespace tessera::test_device
