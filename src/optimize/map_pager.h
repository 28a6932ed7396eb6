// How a map that is being made is kept within a memory limit: what is far from the frames' cameras
// leaves it and comes back.
#pragma once

#include <Eigen/Geometry>

#include "mapping/block_map.h"
#include "semantics/label_mapper.h"

namespace tessera {

// Of one map; `labels` are that map's, null without. Owner thread only. After an error the map is
// of no use.
class MapPager {
  public:
    virtual ~MapPager() = default;

    // Before a frame is fused: what its camera may see is there.
    virtual Status Bring(const Eigen::Isometry3d& T_world_camera, BlockMap& map,
                         LabelMapper* labels) = 0;
    // After it: the map is below the limit, if what the camera may see is.
    virtual Status Release(const Eigen::Isometry3d& T_world_camera, BlockMap& map,
                           LabelMapper* labels) = 0;
    // After the last one: what is still there is stored, too.
    virtual Status Complete(const BlockMap& map) = 0;
};

}  // namespace tessera
