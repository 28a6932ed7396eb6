// The part of tracking that looks for what moves by itself.
#include "system/tracking_stage.h"

namespace tessera {

std::shared_ptr<const MovingMask> TrackingStage::ExpectMoving(double stamp_s) const {
    if (!config_.moving.enabled || !motion_.last()) return nullptr;
    return moving_.PredictMask(stamp_s, motion_.Predict(stamp_s));
}

void TrackingStage::HintMoving(const MovingHint& hint,
                               const std::optional<Eigen::Isometry3d>& T_world_camera) {
    moving_.SetHint(hint, static_cast<float>(config_.frame.disparity_offset_per_m), T_world_camera);
}

void TrackingStage::MaskMoving(const Frame& frame, const BlockMap& map, bool hidden,
                               TrackedFrame& tracked) {
    const FrameReport& report = tracked.report;
    if (config_.moving.enabled && report.track.status == TrackStatus::kGood)
        tracked.report.moving = moving_.Find(
            {.depth_m = frame.depth_m,
             .disparity_offset_per_m = static_cast<float>(config_.frame.disparity_offset_per_m),
             .farthest_m = static_cast<float>(config_.frame.max_depth_m),
             .stamp_s = frame.stamp_s,
             .T_world_camera = report.track.T_world_camera},
            map, backend_->views());
    const bool moves = report.moving && report.moving->moving_tiles > 0;
    const MovingMask* moving = moves ? report.moving.get() : nullptr;
    const bool colour = tracked.prepared.has_colour;
    if (moves || hidden)
        backend_->Remask(frame, config_.frame, moving, keep_images_, tracked.prepared);
    // A device prepares the whole frame again.
    if (!colour) ForgetColour(tracked.prepared);
    if (report.moving) SetMoving(report.moving, tracked.prepared);
}

}  // namespace tessera
