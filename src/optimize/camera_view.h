// A reduced frame for camera estimation: intensity and depth on three levels, and the pixels to
// compare.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/frame.h"

namespace tessera {

// A pixel with depth on a smooth surface and an intensity edge.
struct CameraViewPoint {
    float u = 0, v = 0;   // pixels of its level
    float depth_m = 0;    // along z
    float intensity = 0;  // [0, 1]
    // Index of the image part, depth range and edge direction; one of kRegions.
    std::uint8_t region = 0;
};

struct CameraView {
    static constexpr int kLevels = 3;
    static constexpr int kRings = 3, kQuarters = 4, kDepths = 2, kDirections = 2;
    static constexpr int kRegions = kRings * kQuarters * kDepths * kDirections;

    struct Level {
        int reduction = 1;  // one pixel here covers this many full-resolution pixels per axis
        // [0, 1], box-averaged. Blurring would move edges that are seen at a slant.
        Image<float> intensity;
        DepthImage depth_m;  // averaged where smooth; 0 where missing or at discontinuities
        std::vector<CameraViewPoint> points;
    };

    double stamp_s = 0;
    std::array<Level, kLevels> levels;  // coarse to fine
};

// `frame` must have colour. The finest level has about 320 columns.
CameraView MakeCameraView(const Frame& frame);

// Returns the camera whose pixels are averages over n x n pixels of this one.
PinholeCamera Averaged(const PinholeCamera& camera, int n);

}  // namespace tessera
