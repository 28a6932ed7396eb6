// Keeps the map in memory within a limit: what lies far from the camera goes once it is in the scan file, and comes back
// before the camera sees it. Moves whole cubes (scan/cube.h): each is wholly in the map or wholly away.
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
#include "system/scan_stage.h"

namespace tessera {

// The map's owner thread only.
class PagingStage {
  public:
    // `wait` (lockstep): what the camera may see is waited for, and what comes and goes when depends on the poses only. Else
    // nothing is waited for, and a frame must not be fused before all that it may see is there.
    PagingStage(const PipelineConfig& config, const PinholeCamera& camera, std::unique_ptr<Pager> pager, bool wait);

    // A new frame, of a camera about where it was last: asks for what comes near, takes what has come.
    void BeginFrame(MappingStage& mapping, ScanStage& scan);
    // The same for where the frame's camera was found to be. Where part of what it may see is not there, the frame is not to
    // be fused any more: no block may be there twice. True: so it was.
    bool AfterTracking(TrackedFrame& tracked, MappingStage& mapping, ScanStage& scan);
    // At the frame's end, what changed in it handed to `scan`: brings the map below its limit if it is above.
    void Release(MappingStage& mapping, ScanStage& scan);
    // An empty map.
    void Reset();
    // The end: nothing comes any more, the file is the writer's alone.
    void Close() { pager_.reset(); }

    // After Close, where the file takes nothing any more: all that is away, whatever the limit.
    Status ReturnAll(MappingStage& mapping, ScanStage& scan);

    // Some blocks left the map, or did and came back: their ids are not in the order of their numbers.
    bool paged() const { return paged_; }
    // What a mesh of the map lacks, for a person; empty if nothing.
    std::string Lacking(const ScanStage& scan) const;
    std::optional<std::string> TakeMessage() { return std::exchange(message_, std::nullopt); }

  private:
    struct Asked {
        std::int64_t key = 0;
        double outside_m = 0;   // as last seen
        std::int64_t frame = 0;  // that it was asked for in
    };
    // A cube of the map, its blocks among `resident_`.
    struct Candidate {
        double outside_m = 0;
        BlockCoord cube;
        std::size_t first = 0, last = 0;
    };

    double Outside(const BlockCoord& cube) const;
    bool Bring(double further_m, MappingStage& mapping, ScanStage& scan);
    void Plan();
    void Want(const BlockCoord& cube);
    void Ask();
    bool Needs(double further_m) const;
    void TakeWhatCame(double further_m, MappingStage& mapping, ScanStage& scan);
    void Put(const StoredCube& cube, MappingStage& mapping, ScanStage& scan);
    std::vector<Candidate> Farthest(const BlockMap& map);
    std::vector<Candidate> ChooseLeaving(const BlockMap& map, const ScanStage& scan);
    bool AllSaved(const Candidate& candidate, const BlockMap& map, const ScanStage& scan) const;

    const double limit_bytes_, cube_m_;
    const double margin_m_;  // around what the camera sees
    const double reach_m_;   // from the camera, the margin included
    const bool wait_;
    std::unique_ptr<Pager> pager_;
    std::unordered_map<std::int64_t, std::int32_t> away_;  // cube key to number of blocks
    std::deque<Asked> asked_, wanted_;                     // under way in order; to be asked for, the nearest first
    std::vector<std::int64_t> lost_;                       // cubes that cannot be read back
    std::optional<Eigen::Isometry3d> T_world_camera_;      // last known
    double step_m_ = 0;                                    // between the last two
    std::vector<std::pair<BlockCoord, BlockId>> resident_;
    std::vector<BlockId> ids_;
    std::int64_t frame_ = 0;
    bool paged_ = false, told_small_ = false, told_lost_ = false;
    std::optional<std::string> message_;
};

}  // namespace tessera
