#include "system/loop_stage.h"

#include <cmath>
#include <utility>

#include "core/stopwatch.h"

namespace tessera {
namespace {

void AddNote(const std::string& note, std::string& warning) {
    if (note.empty()) return;
    warning += (warning.empty() ? "" : "; ") + note;
}

}  // namespace

FieldSettings FieldSettingsOf(const PipelineConfig& pipeline, const PinholeCamera& camera) {
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

LoopStage::LoopStage(const LoopConfig& config, const PipelineConfig& pipeline,
                     const SourceInfo& source, std::optional<LoopCloser::Labels> labels,
                     LoopCloser::MakePager make_pager)
    : config_(config),
      camera_(config, pipeline.motion.max_gap_s),
      place_(source.camera),
      closer_(config, FieldSettingsOf(pipeline, source.camera), source.depth_units_per_m,
              std::move(labels), std::move(make_pager)) {}

void LoopStage::Resume(LoopCloser::Memory memory, double last_stamp_s) {
    closer_.Resume(std::move(memory));
    journal_.Begin(closer_);
    camera_.Resume(last_stamp_s);
}

void LoopStage::AfterTracking(const Frame& frame, const BlockMap& map, TrackingStage& tracking,
                              TrackedFrame& tracked, const LoadAround& bring) {
    lost_ms_ = 0;
    if (!on_) return;
    if (tracked.report.first) place_.Close();
    const LostCamera::Verdict verdict = camera_.Judge(tracked);
    const bool lost = verdict == LostCamera::Verdict::kLost;
    // While a place is checked, a doubtful camera is looked for only there.
    if (!lost && (verdict != LostCamera::Verdict::kDoubtful || place_.open()))
        return Check(tracking, tracked);
    FrameReport& report = tracked.report;
    if (tracked.prepared.valid_depth_pixels > 0) {
        Stopwatch watch;
        std::string note;
        const std::optional<FoundCamera> found = closer_.Relocalise(tracked.prepared, note);
        lost_ms_ = watch.LapMs();
        if (!lost && report.track.status == TrackStatus::kGood && found &&
            SamePlace(found->T_map_camera, report.track.T_world_camera))
            return camera_.Confirm();
        if (found) bring(found->T_map_camera);
        if (found && tracking.TrackFrom(frame, map, found->T_map_camera, tracked)) {
            const StampedPose here{frame.stamp_s, report.track.T_world_camera};
            const bool reached = camera_.CanReach(here);
            if (place_.open() || !reached) {
                const bool confirmed = place_.Begin(tracked.prepared, here.T_world_camera, reached);
                tracked.to_fuse &= confirmed;
                AddNote(confirmed ? kPlaceConfirmed : kPlaceUnconfirmed, note);
            }
            camera_.BackOnTrack(frame.stamp_s);
            camera_.SetLastGood(here);
            closer_.LinkNextTo(found->keyframe);
            return AddNote(note, report.warning);
        }
        if (lost && !found) AddNote(note, report.warning);
    }
    if (lost && report.tracked()) tracking.RejectPose(kPoseUnconfirmed, tracked);
}

void LoopStage::Check(TrackingStage& tracking, TrackedFrame& tracked) {
    if (!place_.open() || !tracked.report.tracked()) return;
    tracked.to_fuse = false;
    const Eigen::Isometry3d T_map_camera = tracked.report.track.T_world_camera;
    if (!place_.Due(T_map_camera)) return;
    Stopwatch watch;
    std::string ignored;
    place_.Remember(tracked.prepared, T_map_camera, tracked.report.track.degenerate);
    const std::optional<FoundCamera> found =
        closer_.Relocalise(tracked.prepared, ignored, T_map_camera);
    const bool possible = place_.Answer(found);
    lost_ms_ += watch.LapMs();
    if (found && possible && !place_.open()) closer_.LinkNextTo(found->keyframe);
    if (possible) return AddNote(place_.open() ? "" : kPlaceConfirmed, tracked.report.warning);
    camera_.Lose();
    tracking.RejectPose(kPlaceRefuted, tracked);
}

double LoopStage::AfterFusion(const Frame& frame, TrackedFrame& tracked,
                              const std::optional<LabelReport>& labels, TrackingStage& tracking,
                              const PutMap& put) {
    Stopwatch watch;
    FrameReport& report = tracked.report;
    if (report.tracked())
        AddNote(closer_.Add(frame, tracked.prepared, report.track, tracked.view, report.fused),
                report.warning);
    if (labels) closer_.AddDetections(frame.index, labels->detections);
    if (auto correction = closer_.Step(config_.rebuild_frames)) {
        tracking.Move(correction->T_new_old);
        place_.Move(correction->T_new_old);
        camera_.Move(correction->T_new_old);
        put(std::move(*correction));
        AddNote("map corrected", report.warning);
    }
    AddNote(closer_.TakeError(), report.warning);
    return lost_ms_ + watch.LapMs();
}

std::string LoopStage::Finish(const PutMap& put) {
    std::string note;
    if (std::exchange(finished_, true)) return note;
    if (auto correction = closer_.Finish(note)) put(std::move(*correction));
    AddNote(closer_.TakeError(), note);
    return note;
}

}  // namespace tessera
