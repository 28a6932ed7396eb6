// Which blocks of the map one depth image may change: those in the camera's frustum that do not lie
// wholly behind what it measured. The cost follows the view, not the size of the map.
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

// What a camera there sees of a map of these blocks, up to `far_m`.
ViewCone MakeViewCone(const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
                      double far_m, const BlockMap::Config& map);

// Block ids in increasing order. Owner thread only; runs TBB inside.
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
