// Finds out from a recording's first seconds what camera took it: views are aligned one after the
// other, those that turned against each other are compared, and one camera is fitted to all of
// these pairs. Colour tells it nearly alone: depths, which err in their own way, only say how far
// away the edges are.
#pragma once

#include <optional>
#include <vector>

#include "core/frame.h"
#include "core/se3.h"
#include "optimize/camera_estimate.h"
#include "optimize/camera_view.h"
#include "tracking/image_aligner.h"

namespace tessera {

// Owner thread only (pairs are summed in parallel; the result does not depend on the number of
// threads). Keeps some 0.8 MB a frame at 640 x 480.
class CameraEstimator {
  public:
    explicit CameraEstimator(const PinholeCamera& camera);

    // In order of time, some 15 a second. Without colour it is left out.
    void Add(const Frame& frame);
    int frames() const { return static_cast<int>(views_.size()); }

    // Nothing where too little was seen: no turns, no edges, no overlap.
    std::optional<CameraEstimate> Estimate() const;

  private:
    Vector6d Velocity(int view) const;

    PinholeCamera camera_;
    ImageAligner aligner_;
    PreparedFrame prepared_;
    std::vector<CameraView> views_;
    std::vector<Eigen::Isometry3d> T_world_camera_;
};

}  // namespace tessera
