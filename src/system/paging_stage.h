// Keeps the map in memory within a limit: what lies far from the camera goes once it is in the scan
// file, and comes back before the camera sees it. Moves whole cubes (scan/cube.h): each is wholly
// in the map or wholly away.
#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "scan/pager.h"
#include "system/mapping_stage.h"
#include "system/paging_config.h"
#include "system/rebuild_paging.h"
#include "system/scan_stage.h"
#include "system/viewed_cubes.h"

namespace tessera {

// The map's owner thread only.
class PagingStage {
  public:
    // `wait` (lockstep): what the camera may see is waited for, and what comes and goes when
    // depends on the poses only. Else nothing is waited for, and a frame must not be fused before
    // all that it may see is there.
    PagingStage(const PipelineConfig& config, const PinholeCamera& camera,
                std::unique_ptr<Pager> pager, bool wait);

    // A new frame, of a camera about where it was last: asks for what comes near, takes what has
    // come.
    void BeginFrame(MappingStage& mapping, ScanStage& scan);
    // The same for where the frame's camera was found to be. Where part of what it may see is not
    // there, the frame is not to be fused any more: no block may be there twice. True: so it was.
    bool AfterTracking(TrackedFrame& tracked, MappingStage& mapping, ScanStage& scan);
    // At the frame's end, what changed in it handed to `scan`: brings the map below its limit if it
    // is above.
    void Release(MappingStage& mapping, ScanStage& scan);
    // What a fused frame's camera saw stays until LetGo, however far the camera goes: something of
    // that frame is still to come.
    void Hold(std::int64_t frame, const Eigen::Isometry3d& T_world_camera) {
        held_.push_back({frame, T_world_camera});
    }
    // Of that frame and those before it nothing comes any more.
    void LetGo(std::int64_t frame);
    // A corrected map is in place of the one so far, made with the pager (a RebuildPaging): what of
    // it is away is where that has put it, until the file has it.
    void Replaced(const Eigen::Isometry3d& T_new_old, const RebuildPaging& pager,
                  MappingStage& mapping, ScanStage& scan);
    // What a camera may see from there comes, and the camera is thought to be where it was: it may
    // soon be tracked there. Lockstep.
    void BringAround(const Eigen::Isometry3d& T_world_camera, MappingStage& mapping,
                     ScanStage& scan);
    // Live: it comes in the next frames, and stays for some seconds.
    void Expect(const Eigen::Isometry3d& T_world_camera) {
        expected_ = {frame_ + kExpectFrames, T_world_camera};
    }
    // An empty map.
    void Reset();
    // The end: nothing comes any more, the file is the writer's alone.
    void Close() { pager_.reset(); }

    // After Close, where the file takes nothing any more: all that is away, whatever the limit.
    Status ReturnAll(MappingStage& mapping, ScanStage& scan);

    // Some blocks left the map, or did and came back: their ids are not in the order of their
    // numbers.
    bool paged() const { return paged_; }
    // What a mesh of the map lacks, for a person; empty if nothing.
    std::string Lacking(const ScanStage& scan) const;
    std::optional<std::string> TakeMessage() { return std::exchange(message_, std::nullopt); }

  private:
    struct Asked {
        std::int64_t key = 0;
        double outside_m = 0;    // as last seen
        std::int64_t frame = 0;  // that it was asked for in
    };
    struct Held {
        std::int64_t frame = 0;
        Eigen::Isometry3d T_world_camera;
    };

    static constexpr std::int64_t kExpectFrames = 150;

    double Outside(const BlockCoord& cube) const;
    bool IsExpected(const BlockCoord& cube) const;
    void Drain();
    bool AwaitReplaced(MappingStage& mapping, ScanStage& scan);
    void ReturnFromStore(MappingStage& mapping, ScanStage& scan);
    bool Bring(double further_m, MappingStage& mapping, ScanStage& scan);
    void Plan();
    void Want(const BlockCoord& cube);
    void Ask();
    bool Needs(double further_m) const;
    void TakeWhatCame(double further_m, MappingStage& mapping, ScanStage& scan);
    void Put(const StoredCube& cube, MappingStage& mapping, ScanStage& scan);
    std::vector<ResidentCubes::Cube> ChooseLeaving(const BlockMap& map, const ScanStage& scan);
    bool AllSaved(const ResidentCubes::Cube& cube, const BlockMap& map,
                  const ScanStage& scan) const;
    bool IsHeld(const BlockCoord& cube) const;

    const double limit_bytes_;
    const ViewedCubes viewed_;
    const bool wait_;
    std::unique_ptr<Pager> pager_;
    std::unordered_map<std::int64_t, std::int32_t> away_;  // cube key to number of blocks
    // Under way in order; to be asked for, the nearest first.
    std::deque<Asked> asked_, wanted_;
    std::vector<std::int64_t> lost_;                   // cubes that cannot be read back
    std::optional<Eigen::Isometry3d> T_world_camera_;  // last known
    double step_m_ = 0;                                // between the last two
    // Of a map that the file does not have yet; else null.
    std::shared_ptr<const CubeScratch> store_;
    std::optional<Held> expected_;  // until that frame
    std::deque<Held> held_;         // by increasing frame
    ResidentCubes resident_;
    std::vector<BlockId> ids_;
    std::int64_t frame_ = 0;
    bool paged_ = false, told_small_ = false, told_lost_ = false;
    std::optional<std::string> message_;
};

}  // namespace tessera
