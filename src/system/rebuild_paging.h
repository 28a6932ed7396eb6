// Keeps a corrected map under construction within the same memory limit as the current map. The
// scan file is not touched until the map is complete.
#pragma once

#include <functional>
#include <map>
#include <memory>

#include "optimize/map_pager.h"
#include "scan/cube_scratch.h"
#include "system/viewed_cubes.h"

namespace tessera {

class RebuildPaging : public MapPager {
  public:
    RebuildPaging(const PipelineConfig& config, const PinholeCamera& camera,
                  std::shared_ptr<CubeScratch> store);

    Status Bring(const Eigen::Isometry3d& T_world_camera, BlockMap& map,
                 LabelMapper* labels) override;
    Status Release(const Eigen::Isometry3d& T_world_camera, BlockMap& map,
                   LabelMapper* labels) override;
    Status Complete(const BlockMap& map) override;

    // After Complete: holds the whole map.
    const std::shared_ptr<CubeScratch>& store() const { return store_; }
    // Cubes that are only in the store, with their number of blocks.
    const std::map<std::int64_t, std::int32_t>& away() const { return away_; }
    // Ids of the map may not be in the order of block numbers.
    bool paged() const { return paged_; }

  private:
    Status Store(const BlockMap& map, const ResidentCubes::Cube& cube);

    const double limit_bytes_;
    const ViewedCubes viewed_;
    std::shared_ptr<CubeScratch> store_;
    std::map<std::int64_t, std::int32_t> away_;
    ResidentCubes resident_;
    BlockCopies copies_;
    bool paged_ = false;
};

// Creates a new pager for each map, in the scan's folder. The configuration has a limit.
using MakeMapPager = std::function<Result<std::unique_ptr<MapPager>>()>;
MakeMapPager RebuildPagers(const PipelineConfig& config, const PinholeCamera& camera,
                           const std::string& scan_path);

}  // namespace tessera
