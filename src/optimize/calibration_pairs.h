// Finds points of keyframes that lie on surfaces of other keyframes. Self-calibration minimises
// their distances.
#pragma once

#include <span>
#include <vector>

#include "core/camera.h"
#include "optimize/calibration_model.h"
#include "optimize/calibration_view.h"
#include "optimize/pose_graph.h"

namespace tessera {

// Compares points on a grid of each view with the views linked to it by edges, in both directions.
// A pair needs smooth surfaces on both sides, with similar normals and a small distance. Edges
// whose surfaces do not constrain the motion yield no pairs. `camera`: of the full images, as
// given. Deterministic order.
std::vector<PlanePair> FindPlanePairs(const PinholeCamera& camera,
                                      const std::vector<CalibrationView>& views,
                                      std::span<const PoseEdge> edges,
                                      std::span<const Eigen::Isometry3d> T_world_camera,
                                      const CalibrationUnknowns& unknowns);

}  // namespace tessera
