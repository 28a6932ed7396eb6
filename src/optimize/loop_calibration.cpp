// Self-calibration part of LoopCloser: selects the views to compare and applies the result.
#include <utility>

#include "core/se3.h"
#include "optimize/loop_closer.h"
#include "optimize/self_calibration.h"

namespace tessera {

// Loads a view of each keyframe, prepared with the current settings.
Status LoopCloser::LoadViews(std::vector<CalibrationView>& views) {
    Frame frame;
    PreparedFrame prepared;
    for (const StoredFrame& stored : store_.frames()) {
        if (!stored.is_keyframe) continue;
        Status loaded =
            store_.LoadPrepared(stored, settings_.camera, settings_.preparation, frame, prepared);
        if (!loaded.ok())
            return Status::Error("calibration: keeping the given values, " + loaded.message());
        views.emplace_back(prepared.depth_m);
    }
    if (static_cast<int>(views.size()) != keyframes_.size())
        return Status::Error(
            "calibration: keeping the given values, some keyframes' frames were dropped; raise "
            "loops.memory_limit_mb");
    return Status::Ok();
}

// Compares consecutive keyframes, keyframes two apart, and loops. No frame may be added afterwards:
// features and field checks belong to the original calibration.
Status LoopCloser::Calibrate() {
    constexpr double kNothing = 1e3;  // standard deviation of unknown values
    std::vector<CalibrationView> views;
    if (Status loaded = LoadViews(views); !loaded.ok()) return loaded;
    std::vector<PoseEdge> edges = edges_;
    std::vector<Eigen::Isometry3d> poses;
    for (int i = 0; i < keyframes_.size(); ++i) {
        poses.push_back(keyframes_[i].T_world_camera);
        if (i < 2) continue;
        const Eigen::Isometry3d T_before_i =
            Normalised(keyframes_[i - 2].T_world_camera.inverse() * poses.back());
        edges.push_back({i - 2, i, T_before_i, RootInformation(kNothing, kNothing), false});
    }
    const auto report = RefineCalibration(settings_.camera, views, edges, poses);
    if (!report.ok()) return report.status();
    calibration_ = report.value();
    if (!calibration_->shown) return Status::Ok();
    for (int i = 0; i < keyframes_.size(); ++i)
        keyframes_[i].T_world_camera = poses[static_cast<std::size_t>(i)];
    settings_.camera = Corrected(settings_.camera, calibration_->calibration);
    settings_.preparation.disparity_offset_per_m +=
        calibration_->calibration.disparity_offset_per_m;
    corrected_ = true;
    return Status::Ok();
}

}  // namespace tessera
