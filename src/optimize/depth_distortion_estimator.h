// Estimates a depth camera's errors from a recording: the same surface, seen in two places of the
// image, must lie in one place of the world.
#pragma once

#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/frame.h"
#include "optimize/depth_distortion_fit.h"
#include "optimize/depth_view.h"
#include "tracking/image_aligner.h"

namespace tessera {

// Owner thread only. Stores about 0.3 MB per frame.
class DepthDistortionEstimator {
  public:
    explicit DepthDistortionEstimator(const PinholeCamera& camera);

    // In the order of time, about ten per second. Ignores frames without colour.
    void Add(const Frame& frame);
    // The next frame is of another part of the recording; it is not compared with earlier ones.
    void StartPart();

    // Nothing if the recording shows too little: no motion, or no surfaces.
    std::optional<DepthDistortionEstimate> Estimate() const;

  private:
    PinholeCamera camera_;
    ImageAligner aligner_;
    PreparedFrame prepared_;
    int part_ = 0;
    bool first_of_part_ = true;
    std::vector<DepthView> views_;
    std::vector<double> depth_m_;  // median, of each view
    std::vector<int> part_of_;
    std::vector<Eigen::Isometry3d> T_part_camera_;
};

}  // namespace tessera
