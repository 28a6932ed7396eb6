// Keeps a corrected map that is being made within the same limit as the map in use. The file of the
// scan does not hear of it until it is whole.
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

    // After Complete: all of the map.
    const std::shared_ptr<CubeScratch>& store() const { return store_; }
    // The cubes that are there only, with how many blocks.
    const std::map<std::int64_t, std::int32_t>& away() const { return away_; }
    // Ids of the map are not in the order of their numbers.
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

// A new one for each map, in the folder of the scan; an empty function where the configuration has
// no limit.
using MakeMapPager = std::function<Result<std::unique_ptr<MapPager>>()>;
MakeMapPager RebuildPagers(const PipelineConfig& config, const PinholeCamera& camera,
                           const std::string& scan_path);

}  // namespace tessera
