// What a depth camera's calibration lacks, from its own views of a still scene: surfaces that are
// seen from several places agree only if they are measured right. Depth images and poses are solved
// for together.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "core/status.h"
#include "optimize/calibration_report.h"
#include "optimize/calibration_view.h"
#include "optimize/pose_graph.h"

namespace tessera {

// `edges`: which views are to be compared, and what is known of their poses, T_world_camera,
// without it. An estimate is `shown` where it is further than five of its standard deviations
// (Deviations, calibration_fit.h) from the given value; the disparity offset, which a scan shows
// less well and which can make up for other errors, is left at its value where it is not shown.
// Moves the poses along if shown; the first view stays. An error where too little is seen twice or
// where Ceres is missing; the poses are then as they were. One thread: the same result on every
// run.
Result<CalibrationReport> RefineCalibration(const PinholeCamera& camera,
                                            const std::vector<CalibrationView>& views,
                                            std::span<const PoseEdge> edges,
                                            std::vector<Eigen::Isometry3d>& T_world_camera);

}  // namespace tessera
