// How a camera moved at one time of its path.
#pragma once

#include <span>

#include "core/camera.h"
#include "core/se3.h"

namespace tessera {

// Body twist per second (rotation, translation) at `stamp_s`, from the poses beside it. Zero where
// the path has none within 0.2 s, or jumps. `path`: by increasing time. Thread-safe.
Vector6d TwistAt(std::span<const StampedPose> path, double stamp_s);

// Length of the blur of an image, pixels, from how fast the camera turned and an exposure of a
// sixtieth of a second.
float MotionBlur_px(const Vector6d& twist_per_s, const PinholeCamera& camera);

}  // namespace tessera
