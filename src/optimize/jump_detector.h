// Detects when tracking jumps from one surface to another, as opposed to camera motion.
#pragma once

#include <Eigen/Geometry>
#include <optional>

namespace tessera {

// Owner thread only.
class JumpDetector {
  public:
    // Call with time and pose of each tracked frame, in order. Returns the pose predicted by
    // constant velocity if the given pose deviates from it by more than a hand moves and by much
    // more than recently. Accepted as they are: the frame after a jump, and the two after more than
    // one missing frame.
    std::optional<Eigen::Isometry3d> Follow(double stamp_s, const Eigen::Isometry3d& T_map_camera);
    // The map was moved, and the last pose with it.
    void Move(const Eigen::Isometry3d& T_new_old) { T_map_last_ = T_new_old * T_map_last_; }
    // Call if the motion between the last frame and the next is unknown.
    void Reset() { followed_ = 0; }

  private:
    Eigen::Isometry3d T_map_last_ = Eigen::Isometry3d::Identity(),
                      T_before_last_ = Eigen::Isometry3d::Identity();
    double stamp_last_s_ = 0, interval_before_s_ = 0;  // the interval that T_before_last_ took
    int followed_ = 0;                    // frames since the last interruption, at most 2
    double usual_m_ = 0, usual_rad_ = 0;  // running mean of the deviation from the prediction
};

}  // namespace tessera
