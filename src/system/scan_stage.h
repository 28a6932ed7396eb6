// Keeps a scan file up to date while a run goes on: watches what changes, and makes checkpoints of
// it for the thread that writes them. Where a resumed scan's content comes into the stages.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "scan/scan_thread.h"
#include "system/mapping_stage.h"
#include "system/path_log.h"
#include "system/scan_plan.h"

namespace tessera {

// The map's owner thread only.
class ScanStage {
  public:
    // With a file. `wait`: where the writer is late by more than an interval it is waited for; else
    // the checkpoint is put off, and what has changed gathers. `loops`: with loop closure.
    ScanStage(ScanPlan plan, const ScanConfig& config, bool wait, bool loops);
    ~ScanStage();

    // Puts what a resumed file holds into map and labels; before the first frame. Does nothing for
    // a new one. Errors name the file.
    Status Resume(MappingStage& mapping);
    // What loop closure goes on with, after Resume; nothing for a new file.
    std::optional<LoopCloser::Memory> TakeLoops() { return std::exchange(loops_, std::nullopt); }

    // With a new file in the midst of a run: the frames so far, before the first AddFrame.
    void AddPast(const std::vector<PathRecord>& path);
    // A frame after its fusion and labels, with TrackedFrame::tracking_state; `labelled_frames`
    // were offered to the detector so far.
    void AddFrame(const Frame& frame, const TrackedFrame& tracked, std::int64_t labelled_frames);
    // Another map, whole in `store` as it is now, is in place of the one so far: the next
    // checkpoint is of it.
    void Replaced(const BlockMap& map, std::shared_ptr<const CubeScratch> store);
    // That checkpoint is in the file.
    bool HasReplaced() const { return !pending_->stored && thread_.idle() && !thread_.failed(); }
    // What loop closure made of it, or of frames before.
    void AddLoops(LoopNews news);
    // After a correction of the map, which moved cameras in it.
    void Move(const Eigen::Isometry3d& T_new_old) { path_log_.Move(T_new_old); }
    // A checkpoint, if it is time.
    void SaveIfDue(const MappingStage& mapping);
    // Blocks whose labels have changed, which does not count as a change of the block.
    void Touch(std::span<const BlockId> blocks);
    // The file holds the block as it is, or a checkpoint that is under way.
    bool Has(const BlockMap& map, BlockId id) const {
        return static_cast<std::size_t>(id) < seen_revision_.size() &&
               seen_revision_[static_cast<std::size_t>(id)] == map.revision(id);
    }
    // All checkpoints are in the file.
    bool idle() const { return thread_.idle(); }
    bool failed() const { return thread_.failed(); }
    // Waits until they are; `checkpoint`: one more of what has changed since. False: the file takes
    // nothing any more.
    bool Settle(const MappingStage& mapping, bool checkpoint);
    // Blocks that left the map and are in the file, and those that came back from it.
    void Released(std::span<const BlockId> blocks);
    void Returned(const BlockMap& map, std::span<const BlockId> blocks);
    const std::string& path() const { return path_; }
    // The map and the path begin anew.
    void Reset();
    // The last checkpoint, waited for. Once; a new file in which there is nothing goes.
    void Finish(const MappingStage& mapping);

    std::optional<std::string> TakeMessage();
    std::size_t waiting() const { return thread_.waiting(); }

  private:
    using Clock = std::chrono::steady_clock;

    bool Due(double stamp_s) const;
    void AddRaw(const Frame& frame);
    void Checkpoint(const MappingStage& mapping, bool finished);
    void AddBlocks(const MappingStage& mapping);

    ScanConfig config_;
    const bool wait_;
    const std::string path_;
    bool saved_;                          // there is something in the file
    std::optional<ScanContent> resumed_;  // until it is put into the stages
    std::optional<LoopCloser::Memory> loops_;
    ScanThread thread_;
    std::unique_ptr<ScanCheckpoint> pending_;
    ScanProgress progress_;
    PathLog path_log_;
    std::uint64_t map_identity_ = 0;            // of the map that the file has
    std::vector<std::uint32_t> seen_revision_;  // by block: as the file has it
    std::vector<BlockId> changed_;
    bool left_out_ = false;  // some raw frames, the writer being late
    std::optional<std::string> message_;
    std::optional<double> last_stamp_s_;  // of the last checkpoint
    Clock::time_point last_time_;
    bool finished_ = false;
};

}  // namespace tessera
