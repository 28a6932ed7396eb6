#include "viz/system_view.h"

namespace tessera {
namespace {

// Adds now_s to the arrivals of the last `keep_s` seconds (at least two are kept). Returns their
// rate per second.
double RateWith(double now_s, double keep_s, std::deque<double>& arrivals_s) {
    arrivals_s.push_back(now_s);
    while (arrivals_s.size() > 2 && now_s - arrivals_s.front() > keep_s) arrivals_s.pop_front();
    const double span_s = now_s - arrivals_s.front();
    return span_s > 0 ? static_cast<double>(arrivals_s.size() - 1) / span_s : 0;
}

}  // namespace

bool SystemView::Take(ViewerLink& link, double now_s) {
    bool any = false;
    FrameUpdate frame;
    while (link.frames.TryPop(frame)) {
        Add(std::move(frame), now_s);
        any = true;
    }
    while (link.images.TryPop(images_)) {
        ++images_taken_;
        any = true;
    }
    any |= TakeLabels(link, now_s);
    std::string message;
    while (link.messages.TryPop(message)) {
        Say(message);
        any = true;
    }
    return any;
}

bool SystemView::TakeLabels(ViewerLink& link, double now_s) {
    bool any = false;
    LabelUpdate labels;
    while (link.labels.TryPop(labels)) {
        if (!labels.stopped) detections_per_s_ = RateWith(now_s, 5, detected_s_);
        labels_ = std::move(labels);
        any = true;
    }
    if (link.classes.TryPop(classes_)) {  // a detector is in use, perhaps after another failed
        labels_.stopped = false;
        any = true;
    }
    any |= link.detectors.TryPop(detector_);
    std::vector<MapObject> objects;
    while (link.objects.TryPop(objects)) {
        SetObjects(std::move(objects));
        any = true;
    }
    return any;
}

void SystemView::SetObjects(std::vector<MapObject> objects) {
    objects_ = std::move(objects);
    ++objects_taken_;
}

void SystemView::Say(const std::string& text) {
    ++messages_said_;
    messages_.push_back(text);
    if (messages_.size() > kMostMessages) messages_.pop_front();
}

void SystemView::Add(FrameUpdate&& update, double now_s) {
    const FrameReport& report = update.report;
    recent_.Add(update, now_s);
    if (report.first && !report.begins_part) {
        path_.clear();
        truth_.clear();
        ++path_identity_;
        SetObjects({});
        labels_.detections.clear();
    }
    const bool follows = has_frame_ && frame_.report.tracked() && !report.first;
    if (report.tracked())
        path_.push_back({report.track.T_world_camera.translation().cast<float>(),
                         report.track.status, follows});
    if (update.T_world_camera_truth)
        truth_.push_back({update.T_world_camera_truth->translation().cast<float>(),
                          TrackStatus::kGood,
                          has_frame_ && frame_.T_world_camera_truth && !report.first});
    frame_ = std::move(update);
    has_frame_ = true;

    fps_ = RateWith(now_s, 3, arrivals_s_);
    AddToHistory();
}

void SystemView::AddToHistory() {
    const FrameReport& report = frame_.report;
    const auto add = [](Series& series, double value) {
        AddValue(static_cast<float>(value), series);
    };
    History& h = history_;
    add(h.decode_ms, frame_.decode_ms);
    add(h.prepare_ms, report.prepare_ms);
    add(h.track_ms, report.track_ms);
    add(h.fuse_ms, report.fusion.allocate_ms + report.fusion.fuse_ms);
    add(h.mesh_ms, frame_.mesh_ms);
    add(h.latency_ms, frame_.latency_ms);
    // The first frame starts the map, so there is nothing to compare it with.
    add(h.inlier_percent, report.first ? 100 : 100 * report.track.inlier_fraction);
    add(h.rms_mm, 1000 * report.track.distance_rms_m);
    add(h.map_mb, static_cast<double>(frame_.map.bytes) / (1 << 20));
    add(h.dropped, static_cast<double>(frame_.counts.dropped));
    for (const auto& [name, waiting] : frame_.queues)
        add(h.queued[name], static_cast<double>(waiting));
}

}  // namespace tessera
