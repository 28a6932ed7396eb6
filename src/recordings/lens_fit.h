// Approximates a lens of any model by the Brown-Conrady model of core/camera.h, which is all that
// the rest of the program knows.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/camera.h"

namespace tessera {

// A direction (x / z, y / z), and the one in which the lens shows it.
struct LensPoint {
    Eigen::Vector2d ideal, seen;
};

struct LensFit {
    LensDistortion lens;
    double largest_px = 0;  // the largest error at any of the points; infinity: nothing fits
};

// Keeps the largest error over `points` as small as possible, in pixels of a camera with the focal
// length `focal_px`. `points` should be a grid over the image. Thread-safe.
LensFit FitLens(std::span<const LensPoint> points, double focal_px);

}  // namespace tessera
