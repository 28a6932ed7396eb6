#include "system/loop_stage.h"

#include <cmath>
#include <utility>

#include "core/stopwatch.h"

namespace tessera {
namespace {

FieldSettings SettingsOf(const PipelineConfig& pipeline, const PinholeCamera& camera) {
    FieldSettings settings;
    settings.camera = camera;
    settings.map = pipeline.map;
    settings.fusion = pipeline.fusion;
    settings.preparation = pipeline.frame;
    settings.tracker = pipeline.trackers.sdf;
    settings.photometric = pipeline.trackers.photometric;
    settings.judge = pipeline.trackers.judge;
    return settings;
}

void AddNote(const std::string& note, std::string& warning) {
    if (note.empty()) return;
    warning += (warning.empty() ? "" : "; ") + note;
}

}  // namespace

LoopStage::LoopStage(const LoopConfig& config, const PipelineConfig& pipeline, const SourceInfo& source)
    : config_(config),
      max_gap_s_(pipeline.motion.max_gap_s),
      closer_(config, SettingsOf(pipeline, source.camera), source.depth_units_per_m) {}

void LoopStage::Resume(LoopCloser::Memory memory, double last_stamp_s) {
    closer_.Resume(std::move(memory));
    last_tracked_s_ = last_stamp_s;
    resumed_ = true;
}

bool LoopStage::FitsWell(const TrackResult& track) const {
    return track.status == TrackStatus::kGood && track.inlier_fraction >= config_.min_fit &&
           track.known_fraction >= config_.min_known_fraction;
}

void LoopStage::AfterTracking(const Frame& frame, const BlockMap& map, TrackingStage& tracking, TrackedFrame& tracked) {
    FrameReport& report = tracked.report;
    lost_ms_ = 0;
    if (std::exchange(resumed_, false)) lost_ = std::abs(frame.stamp_s - last_tracked_s_) > max_gap_s_;
    // Before the first keyframe there is nothing to lose.
    lost_ = (lost_ || !report.tracked()) && !report.first && !closer_.keyframes().empty();
    if (!lost_) {
        if (report.tracked()) last_tracked_s_ = frame.stamp_s;
        return;
    }
    const bool lately = frame.stamp_s - last_tracked_s_ <= max_gap_s_;
    bool found = FitsWell(report.track) && (lately || !tracked.prepared.has_colour());
    if (!found && tracked.prepared.valid_depth_pixels > 0) {
        Stopwatch watch;
        std::string note;
        const auto T_map_camera = closer_.Relocalise(tracked.prepared, note);
        lost_ms_ = watch.LapMs();
        found = T_map_camera && tracking.TrackFrom(frame, map, *T_map_camera, tracked);
        AddNote(note, report.warning);
    }
    if (found) {
        lost_ = false;
        last_tracked_s_ = frame.stamp_s;
    } else if (report.tracked()) {
        tracking.Disbelieve("nothing confirms that the camera is where it seems to be after the loss", tracked);
    }
}

double LoopStage::AfterFusion(const Frame& frame, TrackedFrame& tracked, TrackingStage& tracking,
                              MappingStage& mapping) {
    Stopwatch watch;
    FrameReport& report = tracked.report;
    if (report.tracked())
        AddNote(closer_.Add(frame, tracked.prepared, report.track, tracked.view, report.fused), report.warning);
    if (auto correction = closer_.Step()) {
        mapping.Replace(std::move(correction->map));
        tracking.Move(correction->T_new_old);
        AddNote("map corrected", report.warning);
    }
    return lost_ms_ + watch.LapMs();
}

void LoopStage::Finish(MappingStage& mapping) {
    if (std::exchange(finished_, true)) return;
    if (auto correction = closer_.Finish()) mapping.Replace(std::move(correction->map));
}

}  // namespace tessera
