// Tells a tracker that slipped from one surface to another from a camera that moved.
#pragma once

#include <Eigen/Geometry>
#include <optional>

namespace tessera {

// Owner thread only.
class JumpDetector {
  public:
    // The pose of each tracked frame, in order. A value: where the camera was expected, going on as
    // before, as it is farther from there than a hand moves it and far farther than it was lately.
    // After one, the next frame is taken as it is.
    std::optional<Eigen::Isometry3d> Follow(const Eigen::Isometry3d& T_map_camera);
    // The map was moved, the last pose with it.
    void Move(const Eigen::Isometry3d& T_new_old) { T_map_last_ = T_new_old * T_map_last_; }
    // What lies between the last frame and the next is not known.
    void Reset() { followed_ = 0; }

  private:
    Eigen::Isometry3d T_map_last_ = Eigen::Isometry3d::Identity(),
                      T_before_last_ = Eigen::Isometry3d::Identity();
    int followed_ = 0;                    // frames since the last break, at most 2
    double usual_m_ = 0, usual_rad_ = 0;  // off the expected pose, smoothed over frames
};

}  // namespace tessera
