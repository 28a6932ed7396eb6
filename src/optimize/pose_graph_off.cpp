// Stubs for builds without Ceres; they return errors.
#include "optimize/calibration_solver.h"
#include "optimize/pose_graph.h"

namespace tessera {

bool PoseGraphAvailable() { return false; }

Status OptimisePoses(std::span<const PoseEdge>, std::vector<Eigen::Isometry3d>&) {
    return Status::Error("this build has no pose graph; install libceres-dev and rebuild");
}

Result<CalibrationEstimate> SolveCalibration(const CalibrationProblem&,
                                             const std::vector<Eigen::Isometry3d>&,
                                             const CalibrationMask&) {
    return Status::Error("this build cannot calibrate; install libceres-dev and rebuild");
}

}  // namespace tessera
