#include "run/run_window.h"

namespace tessera {

void RunWindow::Show(const FrameOutcome& outcome, const RunCounts& counts,
                     const std::optional<Eigen::Isometry3d>& T_world_camera_truth) {
    if (viewer_ == nullptr) return;
    FrameUpdate update;
    update.report = outcome.report;
    update.T_world_camera_truth = T_world_camera_truth;
    update.decode_ms = outcome.decode_ms;
    update.mesh_ms = outcome.mesh_ms;
    update.latency_ms = outcome.latency_ms;
    update.counts = counts;
    update.dropped = counts.dropped;
    update.queues = outcome.queues;
    update.map = outcome.map;
    viewer_->frames.Push(std::move(update));
}

void RunWindow::Show(const LabelReport& report, const LabelClasses& classes) {
    if (viewer_ == nullptr) return;
    LabelUpdate update;
    update.stamp_s = report.stamp_s;
    update.detect_ms = report.detect_ms;
    for (const Detection& d : report.detections)
        update.detections.push_back(
            {d.box, classes.name(d.class_id), d.probability, classes.colour(d.class_id)});
    viewer_->labels.Push(std::move(update));
}

void RunWindow::Show(const LabelClasses& classes) {
    if (viewer_ != nullptr) viewer_->classes.Push(LabelClasses(classes));
}

void RunWindow::ShowDetector(const std::string& name) {
    if (viewer_ != nullptr) viewer_->detectors.Push(std::string(name));
}

void RunWindow::EndLabels() {
    if (viewer_ == nullptr) return;
    LabelUpdate update;
    update.stopped = true;
    viewer_->labels.Push(std::move(update));
}

void RunWindow::ShowObjects(const std::vector<MapObject>& objects) {
    if (viewer_ != nullptr) viewer_->objects.Push(std::vector<MapObject>(objects));
}

void RunWindow::Say(const std::string& text) {
    if (viewer_ != nullptr) viewer_->messages.Push(std::string(text));
}

}  // namespace tessera
