// Which blocks of the map one depth image may change: those in the camera's frustum that do not lie wholly behind what
// it measured. The cost follows the view, not the size of the map.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "mapping/block_map.h"

namespace tessera {

// Nearest and farthest valid depth of each 16 x 16 pixel tile; (1e9, 0) where a tile has none.
struct DepthTiles {
    static constexpr int kTilePx = 16;
    int width = 0, height = 0;
    std::vector<float> nearest_m, farthest_m;

    void Build(const DepthImage& depth_m);
};

// Block ids in increasing order. Owner thread only; runs TBB inside.
class VisibleBlocks {
  public:
    const std::vector<BlockId>& Find(const BlockMap& map, const PinholeCamera& camera,
                                     const Eigen::Isometry3d& T_world_camera, const DepthImage& depth_m,
                                     float farthest_m);

  private:
    DepthTiles tiles_;
    std::vector<BlockCoord> regions_;
    std::vector<BlockId> candidates_;
    std::vector<char> keep_;
    std::vector<BlockId> visible_;
};

}  // namespace tessera
