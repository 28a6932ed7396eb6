#include "finish/path_motion.h"

#include <algorithm>

namespace tessera {

Vector6d TwistAt(std::span<const StampedPose> path, double stamp_s) {
    constexpr double kLongest_s = 0.2, kFastest_m = 5, kFastest_rad = 10;
    const auto after = std::ranges::upper_bound(path, stamp_s, {}, &StampedPose::stamp_s);
    auto before = std::ranges::lower_bound(path, stamp_s, {}, &StampedPose::stamp_s);
    if (after == path.end() || before == path.begin()) return Vector6d::Zero();
    --before;
    const double time_s = after->stamp_s - before->stamp_s;
    if (time_s > kLongest_s) return Vector6d::Zero();
    const Vector6d twist_per_s =
        Se3Log(Normalised(before->T_world_camera.inverse() * after->T_world_camera)) / time_s;
    const bool jumps =
        twist_per_s.head<3>().norm() > kFastest_rad || twist_per_s.tail<3>().norm() > kFastest_m;
    return jumps ? Vector6d::Zero() : twist_per_s;
}

float MotionBlur_px(const Vector6d& twist_per_s, const PinholeCamera& camera) {
    constexpr double kExposure_s = 1.0 / 60;
    return static_cast<float>(twist_per_s.head<3>().norm() * kExposure_s * camera.fx);
}

}  // namespace tessera
