// Stubs for builds without Ceres; they return errors.
#include "optimize/pose_graph.h"
#include "optimize/self_calibration.h"

namespace tessera {

bool PoseGraphAvailable() { return false; }

Status OptimisePoses(std::span<const PoseEdge>, std::vector<Eigen::Isometry3d>&) {
    return Status::Error("this build has no pose graph; install libceres-dev and rebuild");
}

Result<CalibrationReport> RefineCalibration(const PinholeCamera&,
                                            const std::vector<CalibrationView>&,
                                            std::span<const PoseEdge>,
                                            std::vector<Eigen::Isometry3d>&) {
    return Status::Error("this build cannot calibrate; install libceres-dev and rebuild");
}

}  // namespace tessera
