// Chooses the frames that a texture is made from: the sharpest of each stretch of the path.
#pragma once

#include <optional>

#include "core/frame.h"

namespace tessera {

// Owner thread only.
class ViewChoice {
  public:
    // A stretch ends where the camera has moved so far from its first frame. Within it, frames show
    // nearly the same, so their sharpness may be compared.
    static constexpr double kStretch_m = 0.05, kStretch_rad = 0.06;

    // Takes a frame with colour and T_world_camera, in the order of the path. Returns the sharpest
    // of the stretch before, if a new one begins.
    std::optional<Frame> Offer(const Frame& frame);
    // The sharpest of the last stretch.
    std::optional<Frame> Last();

  private:
    std::optional<Frame> best_;
    double best_sharpness_ = 0;
    Eigen::Isometry3d T_world_first_ = Eigen::Isometry3d::Identity();
};

}  // namespace tessera
