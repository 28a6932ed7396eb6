// Which points of keyframes lie on which surfaces of others: what a calibration is judged by.
#pragma once

#include <span>
#include <vector>

#include "core/camera.h"
#include "optimize/calibration_model.h"
#include "optimize/calibration_view.h"
#include "optimize/pose_graph.h"

namespace tessera {

// Points on a grid of each view against the views that edges link it with, both ways, where both
// surfaces are smooth, face the same way and are close; none between two views whose surfaces leave
// a motion open. `camera` is of whole images, as given. The same order on every run.
std::vector<PlanePair> FindPlanePairs(const PinholeCamera& camera,
                                      const std::vector<CalibrationView>& views,
                                      std::span<const PoseEdge> edges,
                                      std::span<const Eigen::Isometry3d> T_world_camera,
                                      const CalibrationUnknowns& unknowns);

}  // namespace tessera
