#include "system/frame_labelling.h"

namespace tessera {

void FrameLabelling::Detect(const Frame& frame, bool always, TrackingStage& tracking) {
    detected_.reset();
    const std::int64_t unfused = unfused_++;
    const bool due =
        unfused > 0 ? unfused % config_.stride == 0 : unused_ || frames_ % config_.stride == 0;
    if (!always && !owed_ && !due) return;
    LabelReport report;
    std::string failure;
    owed_ = stage_.LacksColour(frame);
    if (!stage_.Detect(frame, report, failure)) {
        if (!failure.empty()) failure_ = std::move(failure);
        return;
    }
    if (!report.moving.depth_m.empty()) tracking.HintMoving(report.moving, std::nullopt);
    detected_ = std::move(report);
    unused_ = true;
}

std::optional<LabelReport> FrameLabelling::TakeDetections() {
    ++frames_;
    unfused_ = 0;
    if (detected_) unused_ = false;
    return std::exchange(detected_, std::nullopt);
}

std::optional<DetectorChange> FrameLabelling::Choose(const ViewerSettings& settings) {
    const int choice = settings.detector_choice;
    if (std::exchange(choice_, choice) == choice || settings.detector.empty()) return std::nullopt;
    DetectorChange change = stage_.Change(settings.detector, open_);
    if (change.classes) begun_ = change;
    return change;
}

}  // namespace tessera
