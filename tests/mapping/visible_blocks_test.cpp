#include "mapping/visible_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/se3.h"
#include "support/box_room.h"

namespace tessera {
namespace {

using testing_support::BoxRoom;
using testing_support::SmallCamera;

// A slow reference: a block counts if any of its voxels projects onto a pixel with depth and does
// not lie more than the truncation distance behind the surface.
bool AnyVoxelMayChange(const BlockMap& map, BlockId id, const PinholeCamera& camera,
                       const Eigen::Isometry3d& T_world_camera, const DepthImage& depth) {
    const BlockCoord c = map.coord(id);
    for (int i = 0; i < kBlockVoxels; ++i) {
        const Eigen::Vector3d p_world =
            Eigen::Vector3d(c.x * 8 + (i & 7), c.y * 8 + (i >> 3 & 7), c.z * 8 + (i >> 6)) *
            map.config().voxel_size_m;
        const Eigen::Vector3d p = T_world_camera.inverse() * p_world;
        if (p.z() <= 0.05) continue;
        const Eigen::Vector2d uv = camera.Project(p);
        const int u = static_cast<int>(std::floor(uv.x() + 0.5)),
                  v = static_cast<int>(std::floor(uv.y() + 0.5));
        if (!depth.Contains(u, v) || depth(u, v) <= 0) continue;
        if (depth(u, v) - p.z() >= -map.config().truncation_m) return true;
    }
    return false;
}

TEST(VisibleBlocks, MissesNoBlockThatAVoxelCallsFor) {
    const PinholeCamera camera = SmallCamera();
    BoxRoom room;
    room.has_ball = true;
    BlockMap map({.voxel_size_m = 0.02, .truncation_m = 0.06});
    for (int z = -16; z < 16; ++z)  // blocks both inside and outside the view
        for (int y = -8; y < 8; ++y)
            for (int x = -10; x < 10; ++x) (void)map.Allocate({x, y, z});
    Vector6d twist;
    twist << 0.3, -0.4, 0.2, 0.1, 0.05, -0.2;
    const Eigen::Isometry3d T_world_camera = Se3Exp(twist);
    const Frame frame = room.Render(camera, T_world_camera);
    VisibleBlocks visible;
    const std::vector<BlockId>& found =
        visible.Find(map, camera, T_world_camera, frame.depth_m, 4.0f);
    int wanted = 0;
    for (BlockId id = 1; id < map.size(); ++id)
        if (AnyVoxelMayChange(map, id, camera, T_world_camera, frame.depth_m)) {
            ++wanted;
            ASSERT_TRUE(std::binary_search(found.begin(), found.end(), id)) << id;
        }
    EXPECT_GT(wanted, 500);
    EXPECT_LT(static_cast<int>(found.size()), 2 * wanted);  // it must not return everything
}

}  // namespace
}  // namespace tessera
