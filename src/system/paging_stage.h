// Keeps the map in memory within a limit. Blocks far from the camera are removed once they are in
// the scan file, and are loaded again before the camera sees them. Works on whole cubes
// (scan/cube.h): each is either completely in the map or completely paged out. Reads them on a
// thread of its own, so that nobody has to wait for the disk.
#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/pool.h"
#include "core/worker.h"
#include "scan/cube_reader.h"
#include "system/mapping_stage.h"
#include "system/rebuild_paging.h"
#include "system/scan_stage.h"
#include "system/viewed_cubes.h"

namespace tessera {

// The map's owner thread only.
class PagingStage {
  public:
    // `wait` (lockstep): waits for all that the camera may see, so that paging depends on the poses
    // only. Otherwise never waits, and a frame must not be fused until all that it may see is
    // loaded.
    // `mapping`, `scan` and `notices` outlive the stage; `reader` is of the scan's file.
    PagingStage(const PipelineConfig& config, const PinholeCamera& camera,
                std::unique_ptr<CubeReader> reader, bool wait, MappingStage& mapping,
                ScanStage& scan, Notices& notices);

    // Call at the start of a frame, when the camera is assumed near its last pose. Requests cubes
    // that come near and inserts those that have arrived.
    void BeginFrame();
    // The same at the tracked pose. If part of what the frame may see is not loaded, clears
    // `to_fuse`, so that no block exists twice. Returns true if it did so.
    bool AfterTracking(TrackedFrame& tracked);
    // Call at the end of a frame, after its changes were passed to the scan. Brings the map below
    // its limit.
    void Release();
    // Keeps what this fused frame's camera saw in memory until ReleaseHold: detections of that
    // frame are still to come.
    void Hold(std::int64_t frame, const Eigen::Isometry3d& T_world_camera) {
        held_.push_back({frame, T_world_camera});
    }
    // Ends Hold for this frame and all earlier ones.
    void ReleaseHold(std::int64_t frame);
    // A corrected map, built with `pager`, has replaced the map. Its paged-out part is in the
    // pager's store until the file has it.
    void Replaced(const Eigen::Isometry3d& T_new_old, const RebuildPaging& pager);
    // Lockstep: loads what a camera at this pose may see, because it may be tracked there next. The
    // last known pose does not change.
    void LoadAround(const Eigen::Isometry3d& T_world_camera);
    // Live: loads what a camera at this pose may see over the next frames, and keeps it for some
    // seconds.
    void Expect(const Eigen::Isometry3d& T_world_camera) {
        expected_ = {frame_ + kExpectFrames, T_world_camera};
    }
    // Clears all state, for an empty map.
    void Reset();
    // End of the run: stops loading. From here on, only the writer uses the file.
    void Close() {
        reading_.Stop();
        reader_.reset();
    }

    // After Close, if the file can no longer be written: loads everything back, regardless of the
    // limit.
    Status ReturnAll();

    // Blocks were removed from the map at least once. Ids may no longer be in the order of block
    // numbers.
    bool paged() const { return paged_; }
    // What a mesh of the map lacks, as text for the user. Empty if nothing.
    std::string MissingText() const;

  private:
    struct StoredCube {
        std::int64_t key = 0;
        BlockCopies blocks;
        Status status;  // if an error, `blocks` is invalid
    };
    struct Asked {
        std::int64_t key = 0;
        double outside_m = 0;    // as last computed
        std::int64_t frame = 0;  // in which it was requested
    };
    struct Held {
        std::int64_t frame = 0;  // of the source
        Eigen::Isometry3d T_world_camera;
    };
    struct Expected {
        std::int64_t until = 0;  // as frame_
        Eigen::Isometry3d T_world_camera;
    };

    static constexpr std::int64_t kExpectFrames = 150;
    static constexpr std::size_t kMostAsked = 16;  // cubes that were requested and not yet taken

    double Outside(const BlockCoord& cube) const;
    bool IsExpected(const BlockCoord& cube) const;
    void Drain();
    bool AwaitReplaced();
    bool Bring(double further_m);
    void Plan();
    void Want(const BlockCoord& cube);
    void Ask();
    bool Needs(double further_m) const;
    void Read(std::int64_t key);
    std::unique_ptr<StoredCube> TakeCube(bool wait);
    void InsertLoaded(double further_m);
    void Put(const StoredCube& cube);
    using CubeCounts = std::map<std::int64_t, std::int32_t>;  // cube key to number of blocks
    using ReadCube = std::function<Status(std::int64_t key, BlockCopies& blocks)>;
    void PutBack(const CubeCounts& cubes, const ReadCube& read);
    void PutBackFromStore();
    std::vector<ResidentCubes::Cube> ChooseLeaving();
    bool AllSaved(const ResidentCubes::Cube& cube) const;
    bool IsHeld(const BlockCoord& cube) const;

    const double limit_bytes_;
    const ViewedCubes viewed_;
    const bool wait_;
    MappingStage& mapping_;
    ScanStage& scan_;
    Notices& notices_;
    CubeCounts away_;
    // Requested cubes in order; cubes to request, nearest first.
    std::deque<Asked> asked_, wanted_;
    std::vector<std::int64_t> lost_;                   // cubes that cannot be read back
    std::optional<Eigen::Isometry3d> T_world_camera_;  // last known
    double step_m_ = 0;                                // between the last two poses
    // Store of a corrected map that the file does not have yet; else null.
    std::shared_ptr<const CubeScratch> store_;
    std::optional<Expected> expected_;
    std::deque<Held> held_;  // by increasing frame
    ResidentCubes resident_;
    std::vector<BlockId> ids_;
    std::int64_t frame_ = 0;  // counts calls of BeginFrame
    bool paged_ = false, told_small_ = false, told_lost_ = false;
    std::unique_ptr<CubeReader> reader_;  // the thread's; null after Close
    Pool<StoredCube> pool_;
    Wake owner_;
    FifoQueue<std::unique_ptr<StoredCube>> read_{kMostAsked, owner_};
    Worker<std::int64_t> reading_;
};

}  // namespace tessera
