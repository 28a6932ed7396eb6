#include "mapping/visible_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

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

// They are looked up by region, or in a small map one by one.
TEST(VisibleBlocks, AreTheSameInAMapWithMoreBlocksThanTheViewHasRegions) {
    const PinholeCamera camera = SmallCamera();
    constexpr float kFarthest_m = 4;
    const BlockMap::Config config{.voxel_size_m = 0.02, .truncation_m = 0.06};
    Vector6d twist;
    twist << 0.3, -0.4, 0.2, 0.1, 0.05, -0.2;
    const Eigen::Isometry3d T_world_camera = Se3Exp(twist);
    const Frame frame = BoxRoom().Render(camera, T_world_camera);
    const std::int64_t regions =
        MakeViewCone(camera, T_world_camera, kFarthest_m, config).regions.Count();
    BlockMap small(config), large(config);
    for (BlockMap* map : {&small, &large}) {
        std::mt19937 random(5);
        const auto any = [&] { return static_cast<int>(random() % 16); };
        for (int i = 0; i < 300; ++i) {
            const int x = any() - 8, y = any() - 8, z = any();
            (void)map->Allocate({x, y, z});
        }
        map->Release(7);
    }
    for (int i = 0; large.size() <= regions; ++i)
        (void)large.Allocate({i % 64, i / 64, -1000});  // far behind the camera
    ASSERT_GT(regions, small.size());
    VisibleBlocks visible;
    const std::vector<BlockId> in_small =
        visible.Find(small, camera, T_world_camera, frame.depth_m, kFarthest_m);
    EXPECT_EQ(visible.Find(large, camera, T_world_camera, frame.depth_m, kFarthest_m), in_small);
    EXPECT_GT(in_small.size(), 20u);
    EXPECT_LT(in_small.size(), 200u);
    EXPECT_TRUE(MaySee(small, camera, T_world_camera, kFarthest_m));
    EXPECT_TRUE(MaySee(large, camera, T_world_camera, kFarthest_m));
}

// A hundred thousand million regions.
TEST(VisibleBlocks, OfASmallMapAreFoundAtOnceHoweverFarTheViewReaches) {
    const PinholeCamera camera = SmallCamera();
    constexpr float kFarthest_m = 1000;
    const DepthImage depth_m(camera.width, camera.height, kFarthest_m);
    BlockMap map({.voxel_size_m = 0.005, .truncation_m = 0.02});
    const Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    EXPECT_FALSE(MaySee(map, camera, T_world_camera, kFarthest_m));
    const BlockId ahead = map.Allocate({0, 0, 25});
    (void)map.Allocate({0, 0, -25});
    EXPECT_TRUE(MaySee(map, camera, T_world_camera, kFarthest_m));
    EXPECT_EQ(VisibleBlocks().Find(map, camera, T_world_camera, depth_m, kFarthest_m),
              std::vector{ahead});
}

}  // namespace
}  // namespace tessera
