#include "mapping/ray_ranges.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

void AddBlocksAround(bool with_far_blocks, BlockMap& map) {
    for (int z = -4; z < 24; z += 3)
        for (int y = -9; y < 9; y += 2)
            for (int x = -12; x < 12; x += 2) map.Allocate({x + z % 2, y, z});
    if (with_far_blocks)  // so many that the list of the view's regions is the shorter one
        for (int i = 0; i < 40000; ++i) map.Allocate({1000 + i % 200, i / 200, 500});
}

// Blocks far outside the view change nothing, whichever list of blocks is searched.
TEST(RayRanges, FarBlocksChangeNothing) {
    const PinholeCamera camera{160, 120, 140, 145, 79.5, 60.5};
    const BlockMap::Config config{.voxel_size_m = 0.02, .truncation_m = 0.08};
    BlockMap near(config), both(config);
    AddBlocksAround(false, near);
    AddBlocksAround(true, both);
    for (int i = 0; i < 12; ++i) {
        Eigen::Isometry3d T_world_camera(
            Eigen::AngleAxisd(0.5 * i, Eigen::Vector3d(0.2, 1, 0.1 * i).normalized()));
        T_world_camera.translation() = Eigen::Vector3d(0.1 * i - 0.5, 0.05 * i, 0.2 * i - 0.7);
        RayRanges expected, actual;
        expected.Build(near, camera, T_world_camera, 0.1f, 2.5f);
        actual.Build(both, camera, T_world_camera, 0.1f, 2.5f);
        int covered = 0;
        for (std::size_t k = 0; k < expected.ranges.size(); ++k) {
            ASSERT_EQ(actual.ranges[k].first_m, expected.ranges[k].first_m)
                << "view " << i << ", tile " << k;
            ASSERT_EQ(actual.ranges[k].last_m, expected.ranges[k].last_m)
                << "view " << i << ", tile " << k;
            covered += expected.ranges[k].first_m < expected.ranges[k].last_m;
        }
        EXPECT_GT(covered, 0) << "view " << i;
    }
}

}  // namespace
}  // namespace tessera
