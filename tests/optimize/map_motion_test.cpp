#include "optimize/map_motion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tessera {
namespace {

// A wall seen by two keyframes, of which the nearer one moves.
TEST(MotionOfBlocks, IsTheMeanOfTheKeyframesThatSeeThem) {
    const PinholeCamera camera{160, 160, 160, 160, 79.5, 79.5};
    Keyframes keyframes(camera, 0.7, 10);
    PreparedFrame wall;
    wall.depth_m = DepthImage(160, 160, 2.0f);
    TrackResult at;
    keyframes.Add(0, 0, wall, at);
    wall.depth_m = DepthImage(160, 160, 1.0f);
    at.T_world_camera = Eigen::Translation3d(0.96, 0, 1);
    keyframes.Add(1, 1, wall, at);
    for (int k = 0; k < 2; ++k) keyframes[k].reduced = {};  // only the coarse depth
    std::vector<Eigen::Isometry3d> T_new{Eigen::Isometry3d::Identity(), at.T_world_camera};
    T_new[1].pretranslate(Eigen::Vector3d(0.02, 0, -0.04));
    BlockMap map({.voxel_size_m = 0.04, .truncation_m = 0.16});
    const BlockId left = map.Allocate({-2, 0, 6}), both = map.Allocate({2, 0, 6}),
                  right = map.Allocate({4, 0, 7}), beside = map.Allocate({4, 0, 8}),
                  behind = map.Allocate({4, 0, 12});
    const std::vector<BlockMotion> motions = MotionOfBlocks(map, keyframes, T_new, camera);
    const auto of = [&](BlockId id) { return motions[static_cast<std::size_t>(id)]; };
    const Eigen::Vector3f moved(0.02f, 0, -0.04f);
    EXPECT_TRUE(of(left).seen && of(both).seen && of(right).seen);
    EXPECT_LT(of(left).shift_m.norm(), 1e-6);
    EXPECT_LT((of(right).shift_m - moved).norm(), 1e-6);
    // Its centre is 2.06 m and 1.06 m away.
    const float share = 1 / (1 + 1.06f * 1.06f / (2.06f * 2.06f));
    EXPECT_LT((of(both).shift_m - share * moved).norm(), 1e-6);
    EXPECT_NEAR(of(both).spread_m, std::sqrt(share * (1 - share)) * moved.norm(), 1e-6);
    EXPECT_LT(of(left).spread_m, 1e-6);
    EXPECT_TRUE(of(beside).seen);  // it moves with the block beside it
    EXPECT_LT((of(beside).shift_m - moved).norm(), 1e-6);
    EXPECT_FALSE(of(behind).seen);
}

// One keyframe sees a wall, which the other, of a later time, looks through.
TEST(MotionOfBlocks, OfASurfaceIsThatOfTheKeyframesThatSeeIt) {
    const PinholeCamera camera{160, 160, 160, 160, 79.5, 79.5};
    Keyframes keyframes(camera, 0.7, 10);
    PreparedFrame wall;
    for (const float depth_m : {1.0f, 2.0f}) {
        wall.depth_m = DepthImage(160, 160, depth_m);
        keyframes.Add(0, 0, wall, {});
    }
    for (int k = 0; k < 2; ++k) keyframes[k].reduced = {};
    std::vector<Eigen::Isometry3d> T_new(2, Eigen::Isometry3d::Identity());
    T_new[1].pretranslate(Eigen::Vector3d(0.02, 0, 0));
    BlockMap map({.voxel_size_m = 0.02, .truncation_m = 0.08});
    const BlockId near = map.Allocate({0, 0, 6}), far = map.Allocate({0, 0, 12}),
                  free = map.Allocate({0, 0, 2});
    const std::vector<BlockMotion> motions = MotionOfBlocks(map, keyframes, T_new, camera);
    const auto of = [&](BlockId id) { return motions[static_cast<std::size_t>(id)]; };
    EXPECT_LT(of(near).shift_m.norm(), 1e-6);
    EXPECT_NEAR(of(near).spread_m, 0.01, 1e-6);  // but the other has changed it
    EXPECT_NEAR(of(far).shift_m.x(), 0.02, 1e-6);
    EXPECT_LT(of(far).spread_m, 1e-6);
    EXPECT_NEAR(of(free).shift_m.x(), 0.01, 1e-6);  // no surface: all that see it
}

}  // namespace
}  // namespace tessera
