// Estimates calibration errors of a depth camera from its own views of a static scene. Surfaces
// seen from several places agree only if they are measured correctly. Solves jointly for
// calibration and poses.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "core/status.h"
#include "optimize/calibration_report.h"
#include "optimize/calibration_view.h"
#include "optimize/pose_graph.h"

namespace tessera {

// `edges`: which views to compare, and what is known about their poses T_world_camera without this
// comparison. An estimate is `shown` if it differs from the given value by more than five of its
// standard deviations (Deviations, calibration_fit.h). The disparity offset is less observable and
// can absorb other errors, so it stays at its value unless shown. If shown, also updates the poses;
// the first view stays fixed. Error if the overlap is too small or Ceres is missing; the poses are
// then unchanged. Runs on one thread; deterministic.
Result<CalibrationReport> RefineCalibration(const PinholeCamera& camera,
                                            const std::vector<CalibrationView>& views,
                                            std::span<const PoseEdge> edges,
                                            std::vector<Eigen::Isometry3d>& T_world_camera);

}  // namespace tessera
