// Keeps a map that is being rebuilt within a memory limit: pages out blocks far from the cameras
// and back in.
#pragma once

#include <Eigen/Geometry>

#include "mapping/block_map.h"
#include "semantics/label_mapper.h"

namespace tessera {

// One pager per map. `labels` belong to that map; null without labels. Owner thread only. After an
// error the map must not be used.
class MapPager {
  public:
    virtual ~MapPager() = default;

    // Call before fusing a frame: pages in what its camera may see.
    virtual Status Bring(const Eigen::Isometry3d& T_world_camera, BlockMap& map,
                         LabelMapper* labels) = 0;
    // Call after fusing: pages out until the map is below the limit, as far as the camera's view
    // allows.
    virtual Status Release(const Eigen::Isometry3d& T_world_camera, BlockMap& map,
                           LabelMapper* labels) = 0;
    // Call after the last frame: also stores what is still in memory.
    virtual Status Complete(const BlockMap& map) = 0;
};

}  // namespace tessera
