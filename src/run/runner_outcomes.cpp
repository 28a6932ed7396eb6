// How a run handles each outcome of the engine.
#include <fmt/format.h>

#include <algorithm>

#include "run/runner.h"

namespace tessera {

Status Runner::TakeOutcomes() {
    const double cpu_before_s = MeasureProcess().cpu_s;
    Stopwatch whole;
    FrameOutcome outcome;
    Status status;
    while (status.ok() && engine_->Next(outcome)) {
        if (!begun_) status = Begin();
        if (status.ok()) status = Take(outcome);
        if (observer_.on_frame) observer_.on_frame(summary_.counts, Total());
    }
    if (status.ok()) status = engine_->status();
    if (status.ok() && !begun_) status = BeginWithoutFrames();
    summary_.stopped = engine_->stopped();
    summary_.wall_s = whole.LapMs() / 1000;
    summary_.cpu_s = MeasureProcess().cpu_s - cpu_before_s;
    return status;
}

Status Runner::Take(const FrameOutcome& outcome) {
    using Kind = FrameOutcome::Kind;
    switch (outcome.kind) {
        case Kind::kFrame: TakeFrame(outcome); break;
        case Kind::kSkipped: Skip(outcome.message); break;
        case Kind::kDropped: ++summary_.counts.frames, ++summary_.counts.dropped; break;
        case Kind::kMessage: Warn(outcome.message); break;
        case Kind::kLabels: TakeLabels(*outcome.labels); break;
        case Kind::kLabelsBegin:
            if (request_.viewer != nullptr)
                request_.viewer->detectors.Push(std::string(outcome.detector));
            return BeginLabels(*outcome.classes, outcome.detector);
        case Kind::kLabelsEnd: EndLabels(outcome.message); break;
        case Kind::kReset: return BeginAnew();
    }
    return Status::Ok();
}

void Runner::TakeFrame(const FrameOutcome& outcome) {
    const FrameReport& report = outcome.report;
    Count(outcome);
    if (outcome.T_world_camera_truth)
        truth_.push_back({report.stamp_s, *outcome.T_world_camera_truth});
    if (report.tracked()) {
        estimate_.push_back({report.stamp_s, report.track.T_world_camera});
        tracked_.emplace_back(report.stamp_s, report.fused);
        if (outcome.T_world_camera_truth && !T_map_truth_)
            T_map_truth_ = report.track.T_world_camera * outcome.T_world_camera_truth->inverse();
    }
    const double frame_ms = frame_watch_.LapMs();
    AddTimes(outcome, frame_ms);
    Show(outcome);
    if (outcome.labels) TakeLabels(*outcome.labels);
    if (output_) KeepGoing(output_->AddFrame(report, outcome.decode_ms, frame_ms));
    if (const auto reason = memory_.Check(outcome.map, report.fusion.no_memory)) {
        Warn(*reason);
        engine_->Stop();
    }
}

void Runner::KeepGoing(const Status& written) {
    if (!written.ok() && told_.errors.insert(written.message()).second)
        Warn(written.message() + "; the run goes on and tries again");
}

Status Runner::BeginLabels(const LabelClasses& classes, const std::string& detector) {
    class_names_ = classes;
    if (request_.viewer != nullptr) request_.viewer->classes.Push(LabelClasses(class_names_));
    summary_.detector = detector;
    if (summary_.labels) {
        if (output_) KeepGoing(output_->AddClasses(class_names_));
        return Status::Ok();
    }
    summary_.labels.emplace();
    if (const std::string warning = WarningOf(config_.labels, classes); !warning.empty())
        Warn(warning);
    return output_ ? output_->BeginDetections(class_names_) : Status::Ok();
}

void Runner::TakeLabels(const LabelReport& report) {
    times_.Add("detect", report.detect_ms);
    times_.Add("label", report.vote_ms);
    ++summary_.labels->frames;
    summary_.labels->detections += static_cast<std::int64_t>(report.detections.size());
    summary_.labels->flips += report.votes.flips;
    summary_.labels->settled += report.votes.settled;
    ShowLabels(report);
    if (output_) KeepGoing(output_->AddDetections(report, class_names_));
}

void Runner::EndLabels(const std::string& why) {
    Warn(why);
    if (request_.viewer == nullptr) return;
    LabelUpdate update;
    update.stopped = true;
    request_.viewer->labels.Push(std::move(update));
}

void Runner::Show(const FrameOutcome& outcome) {
    if (request_.viewer == nullptr) return;
    FrameUpdate update;
    update.report = outcome.report;
    if (outcome.T_world_camera_truth && T_map_truth_)
        update.T_world_camera_truth = *T_map_truth_ * *outcome.T_world_camera_truth;
    update.decode_ms = outcome.decode_ms;
    update.mesh_ms = outcome.mesh_ms;
    update.latency_ms = outcome.latency_ms;
    update.counts = summary_.counts;
    update.queues = outcome.queues;
    update.map = outcome.map;
    request_.viewer->frames.Push(std::move(update));
}

void Runner::ShowLabels(const LabelReport& report) {
    if (request_.viewer == nullptr) return;
    LabelUpdate update;
    update.stamp_s = report.stamp_s;
    update.detect_ms = report.detect_ms;
    for (const Detection& d : report.detections)
        update.detections.push_back(
            {d.box, class_names_.name(d.class_id), d.probability, class_names_.colour(d.class_id)});
    request_.viewer->labels.Push(std::move(update));
}

void Runner::AddTimes(const FrameOutcome& outcome, double frame_ms) {
    const FrameReport& report = outcome.report;
    for (const auto& [stage, ms] : {std::pair{"frame", frame_ms},
                                    {"decode", outcome.decode_ms},
                                    {"prepare", report.prepare_ms},
                                    {"track", report.track_ms},
                                    {"moving", report.moving_ms},
                                    {"allocate", report.fusion.allocate_ms},
                                    {"fuse", report.fusion.fuse_ms}})
        times_.Add(stage, ms);
    if (report.rasterise_ms > 0) times_.Add("rasterise", report.rasterise_ms);
    if (request_.live) times_.Add("latency", outcome.latency_ms);
    if (!request_.scan_file.empty()) times_.Add("scan", outcome.scan_ms);
    if (config_.loops.enabled && !request_.live) times_.Add("loops", outcome.loops_ms);
    if (request_.viewer != nullptr) times_.Add("mesh_update", outcome.mesh_ms);
}

Status Runner::BeginAnew() {
    summary_.counts = {};
    if (summary_.labels) summary_.labels.emplace();
    frames_before_ = 0;
    truth_.clear();
    estimate_.clear();
    tracked_.clear();
    T_map_truth_.reset();
    times_ = {};
    told_.status = TrackStatus::kGood;
    told_.degenerate = told_.colour_rejected = false;
    Warn("reset: the map and the path start again");
    if (!output_) return Status::Ok();
    if (Status status = OpenOutput(); !status.ok()) return status;
    const bool chosen_later = summary_.labels && request_.labels.empty();
    return chosen_later ? output_->BeginDetections(class_names_) : Status::Ok();
}

void Runner::Skip(const std::string& message) {
    ++summary_.counts.frames;
    ++summary_.counts.skipped;
    summary_.last_reason = message;
    Warn("skipped: " + message);
}

void Runner::Count(const FrameOutcome& outcome) {
    const FrameReport& report = outcome.report;
    RunCounts& n = summary_.counts;
    ++n.frames;
    n.tracked += report.tracked();
    n.fused += report.fused;
    n.unfused += outcome.fusion_dropped;
    n.poor += report.track.status == TrackStatus::kPoor;
    n.lost += !report.tracked();
    n.degenerate += report.track.degenerate;
    if (!report.tracked()) summary_.last_reason = report.track.reason;
    if (!report.warning.empty()) Warn(fmt::format("frame {}: {}", report.index, report.warning));
    WarnOnStatusChange(report);
}

void Runner::CountLeftOut(const std::vector<StampedPose>& path) {
    std::vector<double> stamps_s;
    for (const StampedPose& pose : path) stamps_s.push_back(pose.stamp_s);
    std::ranges::sort(stamps_s);
    RunCounts& n = summary_.counts;
    for (const auto& [stamp_s, fused] : tracked_) {
        if (std::ranges::binary_search(stamps_s, stamp_s)) continue;
        --n.tracked;
        ++n.lost;
        n.fused -= fused;
    }
}

// Warns only when the tracking status changes, not for every lost frame.
void Runner::WarnOnStatusChange(const FrameReport& report) {
    const TrackResult& t = report.track;
    if (t.status != told_.status || t.degenerate != told_.degenerate) {
        const std::string reason = t.reason.empty() ? "" : ": " + t.reason;
        if (t.status != TrackStatus::kGood)
            Warn(fmt::format("frame {}: {}{}", report.index,
                             t.status == TrackStatus::kLost ? "lost" : "tracked poorly, not fused",
                             reason));
        else if (t.degenerate)
            Warn(fmt::format("frame {}: degenerate, the scene leaves some motion unconstrained{}",
                             report.index, reason));
        else
            Warn(fmt::format("frame {}: tracking is good again", report.index));
    }
    if (report.tracked() && t.colour_rejected != told_.colour_rejected) {
        told_.colour_rejected = t.colour_rejected;
        Warn(fmt::format("frame {}: {}", report.index,
                         told_.colour_rejected
                             ? "the colour image does not fit the map (dark, dazzled "
                               "or frozen?); only the depth is used"
                             : "the colour image fits the map again"));
    }
    told_.status = t.status;
    told_.degenerate = t.degenerate;
}

}  // namespace tessera
