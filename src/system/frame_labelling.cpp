#include "system/frame_labelling.h"

namespace tessera {

void FrameLabelling::Detect(const Frame& frame, bool always, TrackingStage& tracking) {
    detected_.reset();
    if (!always && !owed_ && frames_ % config_.stride != 0) return;
    LabelReport report;
    std::string failure;
    owed_ = stage_.LacksColour(frame);
    if (!stage_.Detect(frame, report, failure)) {
        if (!failure.empty()) failure_ = std::move(failure);
        return;
    }
    if (!report.moving.depth_m.empty()) tracking.HintMoving(report.moving, std::nullopt);
    detected_ = std::move(report);
}

std::optional<LabelReport> FrameLabelling::TakeDetections() {
    ++frames_;
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
