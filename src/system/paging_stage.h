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
    // The same for where the camera is. False: part of what it may see is still away.
    bool Bring(const Eigen::Isometry3d& T_world_camera, MappingStage& mapping, ScanStage& scan);
    // At the frame's end, what changed in it handed to `scan`: brings the map below its limit if it is above.
    void Release(MappingStage& mapping, ScanStage& scan);
    // An empty map.
    void Reset();
    // The end: nothing comes any more, the file is the writer's alone.
    void Close() { pager_.reset(); }

    bool any_away() const { return !away_.empty(); }
    const Status& status() const { return status_; }  // an error: what was away cannot be read back
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
    void Plan();
    void Ask();
    bool NeedsOneOf(const std::deque<Asked>& cubes) const;
    void TakeWhatCame(MappingStage& mapping, ScanStage& scan);
    void Put(const StoredCube& cube, MappingStage& mapping, ScanStage& scan);
    std::vector<Candidate> Farthest(const BlockMap& map);
    bool AllSaved(const Candidate& candidate, const BlockMap& map, const ScanStage& scan) const;

    const double limit_bytes_, cube_m_, reach_m_;
    const bool wait_;
    std::unique_ptr<Pager> pager_;
    std::unordered_map<std::int64_t, std::int32_t> away_;  // cube key to number of blocks
    std::deque<Asked> asked_, wanted_;                     // under way in order; to be asked for, the nearest first
    std::optional<Eigen::Isometry3d> T_world_camera_;      // last known
    std::vector<std::pair<BlockCoord, BlockId>> resident_;
    std::vector<BlockId> ids_;
    std::int64_t frame_ = 0;
    bool told_ = false;
    std::optional<std::string> message_;
    Status status_;
};

// Where the configuration has a memory limit: a stage for the map that is being saved to `scan_path`.
Status StartPaging(const PipelineConfig& config, const PinholeCamera& camera, const std::string& scan_path, bool wait,
                   std::unique_ptr<PagingStage>& paging);

}  // namespace tessera
