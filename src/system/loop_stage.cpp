#include "system/loop_stage.h"

#include <cmath>
#include <utility>

#include "core/notices.h"
#include "core/stopwatch.h"

namespace tessera {

using Question = CameraSearch::Question;

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
      search_(config, pipeline.motion.max_gap_s, source.camera),
      closer_(config, FieldSettingsOf(pipeline, source.camera), source.depth_units_per_m,
              std::move(labels), std::move(make_pager)) {}

void LoopStage::Resume(LoopCloser::Memory memory, double last_seen_s, bool lost) {
    closer_.Resume(std::move(memory));
    journal_.Begin(closer_);
    search_.Resume(last_seen_s, lost);
}

void LoopStage::AfterTracking(const Frame& frame, const BlockMap& map, TrackingStage& tracking,
                              TrackedFrame& tracked, const LoadAround& bring) {
    lost_ms_ = 0;
    tracked.found_at.reset();
    if (!on_) return;
    Stopwatch watch;
    const CameraSearch::Step step = search_.AfterTracking(tracked, true);
    const bool found =
        step.question == Question::kWhere && Find(frame, map, step, tracking, tracked, bring);
    if (step.question == Question::kSecondView) CheckPlace(tracking, tracked);
    if (step.lost && !found && tracked.report.tracked())
        tracking.RejectPose(kPoseUnconfirmed, tracked);
    search_.TellWhereFound(tracked);
    if (step.question != Question::kNone) lost_ms_ = watch.LapMs();
}

// Returns true if the camera was found, and the frame was tracked there.
bool LoopStage::Find(const Frame& frame, const BlockMap& map, const CameraSearch::Step& step,
                     TrackingStage& tracking, TrackedFrame& tracked, const LoadAround& bring) {
    std::string note;
    const std::optional<FoundCamera> found =
        closer_.Relocalise(tracked.report.stamp_s, tracked.prepared, note);
    if (!found) {
        if (step.lost) AddNote(note, tracked.report.warning);
        return false;
    }
    if (!step.lost && search_.Confirms(*found, tracked)) return true;
    bring(found->T_map_camera);
    if (!tracking.TrackFrom(frame, map, found->T_map_camera, tracked)) return false;
    AddNote(search_.Land(*found, tracked), note);
    AddNote(note, tracked.report.warning);
    return true;
}

void LoopStage::CheckPlace(TrackingStage& tracking, TrackedFrame& tracked) {
    std::string ignored;
    const char* note = "";
    if (search_.TakeSecondView(closer_.Relocalise(tracked.report.stamp_s, tracked.prepared, ignored,
                                                  tracked.report.track.T_world_camera),
                               note))
        return AddNote(note, tracked.report.warning);
    tracking.RejectPose(note, tracked);
}

double LoopStage::AfterFusion(const Frame& frame, TrackedFrame& tracked,
                              const std::optional<LabelReport>& labels, TrackingStage& tracking,
                              const PutMap& put) {
    Stopwatch watch;
    FrameReport& report = tracked.report;
    if (tracked.found_at) closer_.LinkNextTo(*tracked.found_at);
    if (report.tracked())
        AddNote(closer_.Add(frame, tracked.prepared, report.track, tracked.view, report.fused),
                report.warning);
    if (labels) closer_.AddDetections(frame.index, labels->detections, labels->ignored);
    if (auto correction = closer_.Step(config_.rebuild_frames)) {
        tracking.Move(correction->T_new_old);
        search_.Move(correction->T_new_old);
        put(std::move(*correction));
        AddNote("map corrected", report.warning);
    }
    AddNote(closer_.TakeError(), report.warning);
    return lost_ms_ + watch.LapMs();
}

std::string LoopStage::Finish(const PutMap& put, const std::function<void()>& free_map) {
    std::string note;
    if (std::exchange(finished_, true)) return note;
    if (auto correction = closer_.Finish(note, nullptr, free_map)) put(std::move(*correction));
    AddNote(closer_.TakeError(), note);
    return note;
}

}  // namespace tessera
