#include "system/scan_stage.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/stopwatch.h"

namespace tessera {
namespace {

constexpr std::uint32_t kNever = ~0u;  // no block's revision: to be saved

LoopCloser::Memory LoopMemory(ScanContent& scan) {
    LoopCloser::Memory memory;
    memory.keyframes = std::move(scan.keyframes);
    memory.edges = std::move(scan.loops.edges);
    for (const PathRecord& record : scan.path)
        if (record.tracked() && record.keyframe >= 0)
            memory.passages.push_back({record.stamp_s, record.keyframe, record.T_reference_camera});
    for (FrameRecord& frame : scan.frames)
        if (frame.in_store) memory.frames.push_back(std::move(frame.stored));
    memory.next_ordinal = scan.loops.next_ordinal;
    memory.loops = scan.loops.loops;
    memory.corrected = scan.loops.corrected;
    return memory;
}

}  // namespace

ScanStage::ScanStage(ScanPlan plan, const ScanConfig& config, bool wait)
    : config_(config),
      wait_(wait),
      path_(plan.file->path()),
      saved_(plan.resumed.has_value()),
      resumed_(std::move(plan.resumed)),
      thread_(std::make_unique<ScanWriter>(std::move(plan.file), plan.depth_units_per_m)),
      pending_(thread_.Take()) {}

ScanStage::~ScanStage() = default;

Status ScanStage::Resume(MappingStage& mapping, LoopStage* loops) {
    if (!resumed_) return Status::Ok();
    ScanContent& scan = *resumed_;
    progress_ = scan.progress;
    map_identity_ = scan.map->identity();
    for (BlockId id = 0; id < scan.map->size(); ++id) seen_revision_.push_back(scan.map->revision(id));
    mapping.Resume(std::move(scan.map), scan.progress.fused_frames);
    StateReader labels(scan.labels);
    if (!scan.labels.empty() && !mapping.LoadLabels(labels))
        return Status::Error(path_ + ": its labels are of other classes; give the same --labels and labels.classes as when it was "
                                     "begun");
    for (const Keyframe& keyframe : scan.keyframes) sent_poses_.push_back({keyframe.T_map_camera, keyframe.T_world_camera});
    next_ordinal_ = scan.loops.next_ordinal;
    if (loops != nullptr) loops->Resume(LoopMemory(scan), scan.progress.last_stamp_s);
    resumed_.reset();
    return Status::Ok();
}

void ScanStage::AfterFrame(const Frame& frame, const TrackedFrame& tracked, const MappingStage& mapping,
                           const LoopStage* loops, std::int64_t labelled_frames) {
    if (thread_.failed()) return;
    Stopwatch watch;
    if (pending_->path.empty()) pending_->first_path = progress_.frames;
    pending_->path.push_back(RecordOf(frame, tracked, loops));
    if (loops != nullptr) AddStored(*loops);
    if (config_.frames == ScanConfig::Frames::kAll) AddRaw(frame);
    ++progress_.frames;
    progress_.labelled_frames = labelled_frames;
    progress_.last_index = frame.index;
    progress_.last_stamp_s = frame.stamp_s;
    pending_->tracking = tracked.tracking_state;
    if (Due(frame.stamp_s)) Checkpoint(mapping, loops, false);
    last_ms_ = watch.LapMs();
}

bool ScanStage::Due(double stamp_s) const {
    if (!last_stamp_s_) return thread_.idle();
    const double longer_s = std::max(std::chrono::duration<double>(Clock::now() - last_time_).count(),
                                     std::abs(stamp_s - *last_stamp_s_));
    return longer_s >= config_.interval_s && (thread_.idle() || (wait_ && longer_s >= 2 * config_.interval_s));
}

PathRecord ScanStage::RecordOf(const Frame& frame, const TrackedFrame& tracked, const LoopStage* loops) const {
    PathRecord record;
    record.index = frame.index;
    record.stamp_s = frame.stamp_s;
    record.status = tracked.report.track.status;
    record.fused = tracked.report.fused;
    record.T_world_camera_truth = frame.T_world_camera;
    if (!record.tracked()) return record;
    record.T_reference_camera = tracked.report.track.T_world_camera;
    if (loops == nullptr || loops->closer().passages().empty()) return record;
    const LoopCloser::Passage& passage = loops->closer().passages().back();
    if (passage.stamp_s != frame.stamp_s) return record;
    record.keyframe = passage.keyframe;
    record.T_reference_camera = passage.T_keyframe_camera;
    return record;
}

// What loop closure has just stored.
void ScanStage::AddStored(const LoopStage& loops) {
    const FrameStore& store = loops.closer().store();
    if (store.next_ordinal() == next_ordinal_) return;
    next_ordinal_ = store.next_ordinal();
    if (store.frames().empty() || store.frames().back().ordinal != next_ordinal_ - 1) return;
    const StoredFrame& stored = store.frames().back();
    FrameRecord record{pending_->path.back().index, stored.stamp_s, stored.colour_stamp_s, true, stored};
    pending_->frames.emplace_back(progress_.frames, std::move(record));
}

// A copy, compressed by the writer. Where that is far behind frames are left out: memory is bounded.
void ScanStage::AddRaw(const Frame& frame) {
    constexpr std::size_t kMostRaw = 90;
    if (!pending_->frames.empty() && pending_->frames.back().first == progress_.frames) return;
    if (wait_ || pending_->raw_frames.size() < kMostRaw) {
        pending_->raw_frames.emplace_back(progress_.frames, std::make_unique<Frame>(frame));
    } else if (!std::exchange(left_out_, true)) {
        message_ = "scan.frames: some frames are left out, the disk is too slow for all";
    }
}

std::optional<std::string> ScanStage::TakeMessage() {
    if (message_) return std::exchange(message_, std::nullopt);
    return thread_.TakeMessage();
}

void ScanStage::Checkpoint(const MappingStage& mapping, const LoopStage* loops, bool finished) {
    thread_.WaitUntilIdle();
    std::unique_ptr<ScanCheckpoint> next = thread_.Take();
    std::swap(pending_->blocks, next->blocks);  // the one just written had room for blocks: the only large part needs to be there once
    AddBlocks(mapping);
    if (loops != nullptr) AddLoops(loops->closer());
    progress_.fused_frames = mapping.fused_frames();
    progress_.labels = mapping.has_labels();
    if (progress_.labels) {
        StateWriter state(pending_->labels);
        mapping.SaveLabels(state);
    }
    pending_->progress = progress_;
    pending_->finished = finished;
    last_stamp_s_ = progress_.last_stamp_s;
    last_time_ = Clock::now();
    saved_ = true;
    thread_.Write(std::move(pending_));
    pending_ = std::move(next);
}

void ScanStage::AddBlocks(const MappingStage& mapping) {
    const BlockMap& map = mapping.map();
    if (map.identity() != map_identity_) {
        pending_->clear_blocks = true;
        map_identity_ = map.identity();
        seen_revision_.clear();
    }
    seen_revision_.resize(static_cast<std::size_t>(map.size()), kNever);
    changed_.clear();
    for (BlockId id = 1; id < map.size(); ++id) {
        std::uint32_t& seen = seen_revision_[static_cast<std::size_t>(id)];
        if (map.IsFree(id) || map.revision(id) == seen) continue;
        seen = map.revision(id);
        changed_.push_back(id);
    }
    pending_->blocks.Copy(map, changed_);
}

void ScanStage::Touch(std::span<const BlockId> blocks) {
    for (const BlockId id : blocks)
        if (static_cast<std::size_t>(id) < seen_revision_.size()) seen_revision_[static_cast<std::size_t>(id)] = kNever;
}

bool ScanStage::Settle(const MappingStage& mapping, bool checkpoint) {
    if (checkpoint && !thread_.failed()) Checkpoint(mapping, nullptr, false);
    thread_.WaitUntilIdle();
    return !thread_.failed();
}

// Their ids may be other blocks' soon.
void ScanStage::Released(std::span<const BlockId> blocks) { Touch(blocks); }

void ScanStage::Returned(const BlockMap& map, std::span<const BlockId> blocks) {
    seen_revision_.resize(std::max(seen_revision_.size(), static_cast<std::size_t>(map.size())), kNever);
    for (const BlockId id : blocks) seen_revision_[static_cast<std::size_t>(id)] = map.revision(id);
}

void ScanStage::AddLoops(const LoopCloser& closer) {
    const Keyframes& keyframes = closer.keyframes();
    for (int id = 0; id < keyframes.size(); ++id) {
        const KeyframePoses poses{keyframes[id].T_map_camera, keyframes[id].T_world_camera};
        const auto at = static_cast<std::size_t>(id);
        if (at == sent_poses_.size()) {
            pending_->keyframes.push_back(keyframes[id]);
            sent_poses_.emplace_back();
        } else if (sent_poses_[at] == poses) {
            continue;
        }
        sent_poses_[at] = poses;
        pending_->poses.emplace_back(id, poses);
    }
    pending_->loops = LoopProgress{closer.edges(), closer.store().next_ordinal(), closer.loops(), closer.corrected()};
}

void ScanStage::Reset() {
    pending_->Clear();
    pending_->clear_all = true;
    progress_ = {};
    map_identity_ = 0;
    seen_revision_.clear();
    sent_poses_.clear();
    next_ordinal_ = 0;
    last_stamp_s_.reset();
}

void ScanStage::Finish(const MappingStage& mapping, const LoopStage* loops) {
    if (std::exchange(finished_, true)) return;
    if (!thread_.failed() && (progress_.frames > 0 || saved_)) Checkpoint(mapping, loops, true);
    thread_.Stop();
}

}  // namespace tessera
