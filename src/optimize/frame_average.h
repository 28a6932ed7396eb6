// Consecutive frames of a camera that hardly moves, averaged into one: the view of the first, its
// depth with less noise, its weight that of all. A map is made again from these at least as well as
// from every frame, and faster ("keyframe fusion", Maier, Stueckler and Cremers, 3DV 2015).
#pragma once

#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/frame.h"
#include "mapping/integrator.h"

namespace tessera {

// Owner thread only; uses TBB internally and gives the same result for any number of threads.
class FrameAverage {
  public:
    // `camera`: of all frames until the next Begin. `T_keyframe_camera`: of the frame, relative to
    // any pose that stays the same until then.
    void Begin(const Frame& frame, const PinholeCamera& camera,
               const Eigen::Isometry3d& T_keyframe_camera, const Integrator::View& view);
    // Adds a frame. Returns false, and adds nothing, if there is no first one, if the camera has
    // moved too far from it, if enough are in it, or if only one of the two has colour that is
    // fused.
    bool Add(const Frame& frame, const Eigen::Isometry3d& T_keyframe_camera,
             const Integrator::View& view);

    bool empty() const { return count_ == 0; }
    // The average so far: the first frame, with the mean depth.
    const Frame& Take();
    const Eigen::Isometry3d& T_keyframe_camera() const { return T_keyframe_camera_; }
    const Integrator::View& view() const { return view_; }

  private:
    PinholeCamera camera_;
    Frame frame_;  // the first
    Eigen::Isometry3d T_keyframe_camera_ = Eigen::Isometry3d::Identity();
    Integrator::View view_;
    int count_ = 0;
    Image<float> sum_m_, samples_;  // of the depths, as seen from the first
};

}  // namespace tessera
