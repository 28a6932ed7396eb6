// A frame made small for finding out what camera took it: intensity and depth on three levels, and
// the pixels that are worth comparing.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/frame.h"

namespace tessera {

// A pixel with depth on a smooth surface and an edge in its intensity.
struct CameraViewPoint {
    float u = 0, v = 0;   // pixels of its level
    float depth_m = 0;    // along z
    float intensity = 0;  // [0, 1]
    // Which part of the image, the depths and the edges' directions: kRegions of them.
    std::uint8_t region = 0;
};

struct CameraView {
    static constexpr int kLevels = 3;
    static constexpr int kRings = 3, kQuarters = 4, kDepths = 2, kDirections = 2;
    static constexpr int kRegions = kRings * kQuarters * kDepths * kDirections;

    struct Level {
        int reduction = 1;  // full-resolution pixels in a row that are one here
        // [0, 1], averaged: blurring would move edges that are seen from aslant.
        Image<float> intensity;
        DepthImage depth_m;  // averaged where smooth; 0 where missing or torn
        std::vector<CameraViewPoint> points;
    };

    double stamp_s = 0;
    std::array<Level, kLevels> levels;  // coarse to fine
};

// `frame` has colour. The finest level has about 320 columns.
CameraView MakeCameraView(const Frame& frame);

// The camera whose pixels are averages over n x n of this one's.
PinholeCamera Averaged(const PinholeCamera& camera, int n);

}  // namespace tessera
