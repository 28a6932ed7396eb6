// Estimates the camera intrinsics from the first seconds of a recording. It aligns consecutive
// views, compares views that are rotated against each other, and fits one camera to all of these
// pairs. The estimate relies almost only on colour. Depth, which has errors of its own, only says
// how far away the edges are.
#pragma once

#include <optional>
#include <vector>

#include "core/frame.h"
#include "core/se3.h"
#include "optimize/camera_estimate.h"
#include "optimize/camera_view.h"
#include "tracking/image_aligner.h"

namespace tessera {

// Owner thread only. Sums pairs in parallel; the result does not depend on the number of threads.
// Stores about 0.8 MB per frame at 640 x 480.
class CameraEstimator {
  public:
    explicit CameraEstimator(const PinholeCamera& camera);

    // In time order, about 15 per second. Ignores frames without colour.
    void Add(const Frame& frame);
    int frames() const { return static_cast<int>(views_.size()); }

    // Returns nothing if the recording shows too little: no rotation, no edges or no overlap.
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
