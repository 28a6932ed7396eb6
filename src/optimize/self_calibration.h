// What a depth camera's calibration lacks, from its own views of a still scene: surfaces that are seen from several places
// agree only if they are measured right. Depth images and poses are solved for together.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/status.h"
#include "optimize/pose_graph.h"

namespace tessera {

// A depth that is too large or too small everywhere is no part of it: no view tells it from a world of another size.
struct Calibration {
    double focal_scale = 1;             // true focal length over the one that was given, both axes
    double disparity_offset_per_m = 0;  // true depth = z / (1 + offset z): a triangulating sensor's error of disparity
};

// The camera with the focal lengths that were found.
PinholeCamera Corrected(const PinholeCamera& camera, const Calibration& calibration);

struct CalibrationReport {
    Calibration calibration;
    double focal_sigma = 0, offset_sigma_per_m = 0;  // standard deviations, of the residuals' scatter
    double rms_before_m = 0, rms_after_m = 0;        // distances of points from surfaces in other views, robust
    int points = 0;                                  // of the last round
};

// A keyframe's depth image, much reduced, and the camera that such an image is of.
class CalibrationView {
  public:
    static constexpr int kReduction = 4;

    // Cells without a clear depth are left out.
    explicit CalibrationView(const DepthImage& depth_m);
    static PinholeCamera ViewOf(const PinholeCamera& camera);

    const DepthImage& depth_m() const { return depth_m_; }

  private:
    DepthImage depth_m_;
};

// Moves the poses, T_world_camera of the views, along. `edges`: which views are to be compared, and what is known of their
// poses without it. The first view stays. An error where the scan does not show it (too few views, too little turning), or
// where Ceres is missing; the poses are then as they were. One thread: the same result on every run.
Result<CalibrationReport> RefineCalibration(const PinholeCamera& camera, const std::vector<CalibrationView>& views,
                                            std::span<const PoseEdge> edges, std::vector<Eigen::Isometry3d>& T_world_camera);

// For a person: what was found, and how to use it from the start.
std::string CalibrationText(const PinholeCamera& camera, const CalibrationReport& report);

}  // namespace tessera
