// The last step after a method has found a pose, the same for every method: evaluates how well the
// frame fits and how well it constrains its pose, and updates the residual model.
#pragma once

#include <functional>

#include "tracking/residual_model.h"
#include "tracking/track_judge.h"

namespace tessera {

// The state at the last sums of the finest level. The local coordinates are those of the method's
// increments.
struct FoundPose {
    Eigen::Isometry3d T_world_local = Eigen::Isometry3d::Identity();
    Eigen::Isometry3d T_local_camera = Eigen::Isometry3d::Identity();
    double scene_depth_m = 1;
    FrameMotion motion;
    double alpha = 0, gain = 1, offset = 0;
    int iterations = 0;
    PoseSums sums;
    double rms_with_shading = 0;  // of intensities before shading was removed; 0: it was not
    SolverOptions options;        // of the last step
    std::int64_t points = 0;      // points with depth
    bool valid = false;           // false: the method found no pose
};

// `residuals`: for the finest points (MakeResidualArguments). `sum`: SumResiduals, or a device that
// holds the points. Owner thread only.
TrackResult Conclude(const TrackInput& input, const FoundPose& found, ResidualArguments residuals,
                     const std::function<ResidualSums(const ResidualArguments&)>& sum,
                     double distance_scale_m, const TrackJudge& judge, ResidualModel& model);

}  // namespace tessera
