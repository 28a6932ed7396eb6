#include "optimize/jump_detector.h"

#include <algorithm>

#include "core/se3.h"

namespace tessera {

std::optional<Eigen::Isometry3d> JumpDetector::Follow(double stamp_s,
                                                      const Eigen::Isometry3d& T_map_camera) {
    // Smallest deviation that counts as a jump: more than a calm hand moves between two frames.
    constexpr double kLeast_m = 0.02, kLeast_rad = 0.015;
    // And this many times the recent deviation, so that shaky motion is no jump.
    constexpr double kTimes = 6;
    constexpr double kShare = 0.1;  // weight of the newest frame in the running mean
    // A frame may be missing; over a longer time a hand does not keep its velocity.
    constexpr double kLongest = 2.5;  // of an interval, in times the one before, and the inverse
    constexpr double kRegular = 1.5;  // the same; less is the stamps' jitter
    std::optional<Eigen::Isometry3d> expected;
    const double interval_s = stamp_s - stamp_last_s_, times = interval_s / interval_before_s_;
    if (followed_ == 2 && times > 1 / kLongest && times < kLongest) {
        const bool regular = times > 1 / kRegular && times < kRegular;
        const Eigen::Isometry3d T_last_expected =
            regular ? T_before_last_ : Se3Exp(times * Se3Log(T_before_last_));
        const Eigen::Isometry3d T_map_expected = Normalised(T_map_last_ * T_last_expected);
        const double off_m = (T_map_camera.translation() - T_map_expected.translation()).norm();
        const double off_rad = RotationAngle(T_map_expected, T_map_camera);
        if (off_m > std::max(kLeast_m, kTimes * usual_m_) ||
            off_rad > std::max(kLeast_rad, kTimes * usual_rad_))
            expected = T_map_expected;
        // Limits the effect of a single jump; frequent ones raise the running mean.
        usual_m_ += kShare * (std::min(off_m, kLeast_m + 2 * usual_m_) - usual_m_);
        usual_rad_ += kShare * (std::min(off_rad, kLeast_rad + 2 * usual_rad_) - usual_rad_);
    }
    if (followed_ > 0) T_before_last_ = Normalised(T_map_last_.inverse() * T_map_camera);
    followed_ = expected ? 1 : std::min(followed_ + 1, 2);
    T_map_last_ = T_map_camera;
    stamp_last_s_ = stamp_s;
    interval_before_s_ = interval_s;
    return expected;
}

}  // namespace tessera
