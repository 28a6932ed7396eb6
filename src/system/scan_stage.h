// Keeps a scan file up to date during a run: tracks changes and builds checkpoints, which a thread
// of its own writes, so that neither compression nor the disk delays anyone.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/notices.h"
#include "core/pool.h"
#include "core/worker.h"
#include "scan/scan_writer.h"
#include "system/mapping_stage.h"
#include "system/path_log.h"
#include "system/scan_plan.h"

namespace tessera {

// The map's owner thread only. Checkpoints are recycled: in steady state nothing large is
// allocated.
class ScanStage {
  public:
    // `plan` has a file. `wait`: waits for the writer if it is late by more than an interval; else
    // postpones the checkpoint and accumulates the changes. `loops`: loop closure is on.
    // `notices` outlives the stage.
    ScanStage(ScanPlan plan, const ScanConfig& config, bool wait, bool loops, Notices& notices);
    ~ScanStage() { Stop(); }

    // Call before the first frame: the file has this map already.
    void Resume(const ScanProgress& progress, const BlockMap& map);
    // For a new file started during a run: adds the earlier frames. Call before the first AddFrame.
    void AddPast(const std::vector<PathRecord>& path);
    // Adds a frame after its fusion and labelling, with TrackedFrame::tracking_state.
    // `labelled_frames`: frames fused with labelling on so far (lockstep).
    void AddFrame(const Frame& frame, const TrackedFrame& tracked, std::int64_t labelled_frames);
    // A corrected map has replaced the map, and `store` holds all of it. The next checkpoint covers
    // it.
    void Replaced(const BlockMap& map, std::shared_ptr<const CubeScratch> store);
    // That checkpoint is in the file.
    bool HasReplaced() const { return !pending_->stored && idle() && !failed(); }
    // Adds loop closure's results for this frame or earlier ones.
    void AddLoops(LoopChanges news);
    // Moves camera poses after a correction of the map.
    void Move(const Eigen::Isometry3d& T_new_old) { path_log_.Move(T_new_old); }
    // Writes a checkpoint if one is due, and no corrected map lacks what is still to follow it.
    void SaveIfDue(const MappingStage& mapping);
    // Marks blocks whose labels have changed, which does not change a block's revision, or that
    // were removed from the map: their ids may soon be used by other blocks.
    void Touch(std::span<const BlockId> blocks);
    // The current version of the block is in the file, or in a checkpoint being written.
    bool Has(const BlockMap& map, BlockId id) const {
        return static_cast<std::size_t>(id) < seen_revision_.size() &&
               seen_revision_[static_cast<std::size_t>(id)] == map.revision(id);
    }
    // All checkpoints are in the file.
    bool idle() const { return writing_.idle(); }
    // Writing has stopped after an error. The file is intact up to the last checkpoint before it.
    bool failed() const { return failed_.load(); }
    // Waits until all checkpoints are in the file. `checkpoint`: first makes another one. Returns
    // false if the file can no longer be written.
    bool Settle(const MappingStage& mapping, bool checkpoint);
    // Blocks that are in the file and were loaded again.
    void Returned(const BlockMap& map, std::span<const BlockId> blocks);
    const std::string& path() const { return path_; }
    // The map and the path start again.
    void Reset();
    // Writes the last checkpoint and waits for it. A new file without content is removed.
    void Finish(const MappingStage& mapping);

    std::size_t waiting() const { return writing_.waiting(); }

  private:
    using Clock = std::chrono::steady_clock;

    bool Due(double stamp_s) const;
    void AddRaw(const Frame& frame);
    void Checkpoint(const MappingStage& mapping, bool finished);
    void AddBlocks(const MappingStage& mapping);
    void MarkSaved(const BlockMap& map);
    void Write(std::unique_ptr<ScanCheckpoint> checkpoint);
    void Stop();

    ScanConfig config_;
    const bool wait_;
    const std::string path_;
    bool saved_ = false;        // the file has content
    const std::string source_;  // empty for a new file, whose meta row has it
    Notices& notices_;
    std::unique_ptr<ScanWriter> writer_;  // the thread's; null after Stop
    Pool<ScanCheckpoint> pool_;
    std::unique_ptr<ScanCheckpoint> pending_;
    ScanProgress progress_;
    PathLog path_log_;
    std::uint64_t map_identity_ = 0;            // of the map in the file
    std::vector<std::uint32_t> seen_revision_;  // by block id: revision in the file
    std::vector<BlockId> changed_;
    bool left_out_ = false;               // raw frames were dropped because the writer was late
    std::optional<double> last_stamp_s_;  // of the last checkpoint
    Clock::time_point last_time_;
    std::atomic<bool> failed_{false};
    Worker<std::unique_ptr<ScanCheckpoint>> writing_;
};

}  // namespace tessera
