// Which blocks of the map one depth image may change: those in the camera's frustum that are not
// wholly behind the measured depth. The cost depends on the view or on the size of the map,
// whichever makes it less.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "mapping/block_map.h"
#include "mapping/visibility_kernels.h"

namespace tessera {

struct DepthTiles {
    int width = 0, height = 0;
    std::vector<float> farthest_m;

    void Build(const DepthImage& depth_m);
    DepthTileView view() const { return {farthest_m.data(), width, height}; }
};

// The frustum of a camera at this pose, up to the end of the band around a measurement at
// `farthest_m`, for a map of this configuration.
ViewCone MakeViewCone(const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
                      float farthest_m, const BlockMap::Config& map);

// Whether a camera that measures no farther than `farthest_m` may see any block of the map.
bool MaySee(const BlockMap& map, const PinholeCamera& camera,
            const Eigen::Isometry3d& T_world_camera, float farthest_m);

// Finds block ids in increasing order. Owner thread only; uses TBB internally.
class VisibleBlocks {
  public:
    const std::vector<BlockId>& Find(const BlockMap& map, const PinholeCamera& camera,
                                     const Eigen::Isometry3d& T_world_camera,
                                     const DepthImage& depth_m, float farthest_m);

  private:
    DepthTiles tiles_;
    std::vector<BlockId> candidates_;
    std::vector<char> keep_;
    std::vector<BlockId> visible_;
};

}  // namespace tessera
