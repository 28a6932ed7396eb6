#include "system/scan_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/check.h"

namespace tessera {
namespace {

constexpr std::uint32_t kNever = ~0u;  // not a block's revision: the block must be saved
// Raw frames that are worth a checkpoint, and the most that wait for one.
constexpr std::size_t kManyRaw = 15, kMostRaw = 90;

}  // namespace

ScanStage::ScanStage(ScanPlan plan, const ScanConfig& config, bool wait, bool loops,
                     Notices& notices)
    : config_(config),
      wait_(wait),
      path_(plan.file->path()),
      source_(plan.source_name),
      notices_(notices),
      writer_(std::make_unique<ScanWriter>(std::move(plan.file), plan.depth_units_per_m)),
      pending_(pool_.Take()),
      path_log_(loops),
      writing_(1, [this](std::unique_ptr<ScanCheckpoint>& job) { Write(std::move(job)); }) {}

void ScanStage::Resume(const ScanProgress& progress, const BlockMap& map) {
    saved_ = true;
    progress_ = progress;
    MarkSaved(map);
}

void ScanStage::MarkSaved(const BlockMap& map) {
    map_identity_ = map.identity();
    seen_revision_.clear();
    for (BlockId id = 0; id < map.size(); ++id) seen_revision_.push_back(map.revision(id));
}

void ScanStage::AddFrame(const Frame& frame, const TrackedFrame& tracked,
                         std::int64_t labelled_frames) {
    if (failed()) return;
    path_log_.Add(progress_.frames, RecordOf(frame, tracked), *pending_);
    if (config_.frames == ScanConfig::Frames::kAll) AddRaw(frame);
    ++progress_.frames;
    progress_.labelled_frames = labelled_frames;
    progress_.last_index = frame.index;
    progress_.last_stamp_s = frame.stamp_s;
    pending_->tracking = tracked.tracking_state;
}

void ScanStage::AddPast(const std::vector<PathRecord>& path) {
    for (const PathRecord& record : path) {
        path_log_.Add(progress_.frames++, record, *pending_);
        progress_.last_index = record.index;
        progress_.last_stamp_s = record.stamp_s;
    }
}

void ScanStage::AddLoops(LoopChanges news) {
    if (failed()) return;
    path_log_.Place(news, *pending_);
    std::ranges::move(news.keyframes, std::back_inserter(pending_->keyframes));
    std::ranges::move(news.poses, std::back_inserter(pending_->poses));
    if (news.progress) pending_->loops = std::move(news.progress);
}

void ScanStage::SaveIfDue(const MappingStage& mapping) {
    if (!failed() && !mapping.following() && Due(progress_.last_stamp_s))
        Checkpoint(mapping, false);
}

bool ScanStage::Due(double stamp_s) const {
    if (!last_stamp_s_) return idle();
    const std::size_t raw = pending_->raw_frames.size();
    if (raw >= kManyRaw && (idle() || (wait_ && raw >= kMostRaw))) return true;
    const double longer_s =
        std::max(std::chrono::duration<double>(Clock::now() - last_time_).count(),
                 std::abs(stamp_s - *last_stamp_s_));
    return longer_s >= config_.interval_s &&
           (idle() || (wait_ && longer_s >= 2 * config_.interval_s));
}

// Keeps a copy, which the writer compresses. If the writer is far behind, live frames are dropped
// to bound the memory.
void ScanStage::AddRaw(const Frame& frame) {
    if (wait_ || pending_->raw_frames.size() < kMostRaw) {
        pending_->raw_frames.emplace_back(progress_.frames, std::make_unique<Frame>(frame));
    } else if (!std::exchange(left_out_, true)) {
        notices_.Tell(
            "scan.frames: some frames were dropped, the disk is too slow for all of them");
    }
}

void ScanStage::Checkpoint(const MappingStage& mapping, bool finished) {
    writing_.WaitUntilIdle();
    path_log_.AddWaiting(*pending_);
    std::unique_ptr<ScanCheckpoint> next = pool_.Take();
    // Reuse the block buffer of the checkpoint just written, so that this large part exists only
    // once.
    std::swap(pending_->blocks, next->blocks);
    AddBlocks(mapping);
    progress_.fused_frames = mapping.fused_frames();
    progress_.labels = mapping.has_labels();
    if (progress_.labels) {
        StateWriter state(pending_->labels);
        mapping.SaveLabels(state);
    }
    pending_->progress = progress_;
    pending_->source = source_;
    pending_->finished = finished;
    last_stamp_s_ = progress_.last_stamp_s;
    last_time_ = Clock::now();
    saved_ = true;
    TESSERA_CHECK(writing_.TryPush(std::move(pending_)), "a checkpoint while one is being written");
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

void ScanStage::Replaced(const BlockMap& map, std::shared_ptr<const CubeScratch> store) {
    pending_->clear_blocks = true;
    pending_->stored = std::move(store);
    MarkSaved(map);
    last_stamp_s_.reset();
}

void ScanStage::Touch(std::span<const BlockId> blocks) {
    for (const BlockId id : blocks)
        if (static_cast<std::size_t>(id) < seen_revision_.size())
            seen_revision_[static_cast<std::size_t>(id)] = kNever;
}

void ScanStage::Write(std::unique_ptr<ScanCheckpoint> checkpoint) {
    const Status status = failed() ? Status::Ok() : writer_->Write(*checkpoint);
    if (!status.ok()) {
        failed_.store(true);
        notices_.Tell("the scan is no longer saved: " + status.message() +
                      "; everything saved before is intact");
    }
    checkpoint->Clear();
    pool_.Give(std::move(checkpoint));
}

bool ScanStage::Settle(const MappingStage& mapping, bool checkpoint) {
    if (checkpoint && !failed()) Checkpoint(mapping, false);
    writing_.WaitUntilIdle();
    return !failed();
}

void ScanStage::Returned(const BlockMap& map, std::span<const BlockId> blocks) {
    seen_revision_.resize(std::max(seen_revision_.size(), static_cast<std::size_t>(map.size())),
                          kNever);
    for (const BlockId id : blocks) seen_revision_[static_cast<std::size_t>(id)] = map.revision(id);
}

void ScanStage::Reset() {
    pending_->Clear();
    pending_->clear_all = true;
    progress_ = {};
    map_identity_ = 0;
    seen_revision_.clear();
    path_log_.Clear();
    last_stamp_s_.reset();
}

void ScanStage::Finish(const MappingStage& mapping) {
    if (!writer_) return;
    if (!failed() && (progress_.frames > 0 || saved_)) Checkpoint(mapping, true);
    Stop();
}

// Waits until everything is written.
void ScanStage::Stop() {
    if (!writer_) return;
    writing_.Finish();
    writer_->Close();
    writer_.reset();
}

}  // namespace tessera
