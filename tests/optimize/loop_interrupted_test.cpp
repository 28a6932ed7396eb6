// Frames are missing, or the camera was lost, while the map is made again.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "optimize/drifting_walk.h"
#include "optimize/loop_closer.h"
#include "optimize/room_walk.h"

namespace tessera {
namespace {

using testing_support::Bias;
using testing_support::Round;
using testing_support::Walker;

// Walks with drift until a corrected map is being made. Returns the last frame's number.
std::size_t WalkUntilTheMapIsMadeAgain(const std::vector<Frame>& frames, Walker& walker) {
    std::size_t i = 0;
    walker.Go(frames[0], Eigen::Isometry3d::Identity());
    while (!walker.closer.HasWork() && i + 1 < frames.size()) {
        ++i;
        walker.Go(frames[i],
                  frames[i - 1].T_world_camera->inverse() * *frames[i].T_world_camera * Bias());
    }
    return i;
}

// After ten frames the camera, which turned and went on, is where it was tracked.
TEST(LoopCloser, FramesThatAreMissingWhileTheMapIsMadeAgainAreNoJump) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> frames = Round();
    Walker walker(LoopConfig{});
    const std::size_t before = WalkUntilTheMapIsMadeAgain(frames, walker);
    ASSERT_TRUE(walker.closer.HasWork());
    ASSERT_EQ(walker.corrections, 0);
    const double interval_s = frames[1].stamp_s - frames[0].stamp_s;
    // The walk ends where it began.
    Frame later = frames[(before + 11) % frames.size()];
    later.stamp_s = frames[before].stamp_s + 11 * interval_s;
    const Eigen::Isometry3d true_step =
        frames[before].T_world_camera->inverse() * *later.T_world_camera;
    ASSERT_GT(true_step.translation().norm(), 0.2);
    const int keyframes = walker.closer.keyframes().size();
    walker.Go(later, true_step * Bias());
    ASSERT_EQ(walker.closer.keyframes().size(), keyframes + 1);
    // Linked to the keyframe before at the place where it was tracked.
    bool linked = false;
    for (const PoseEdge& edge : walker.closer.graph().edges()) {
        if (edge.loop || edge.from != keyframes - 1 || edge.to != keyframes) continue;
        linked = true;
        const Eigen::Isometry3d tracked =
            walker.closer.keyframes()[edge.from].T_map_camera.inverse() *
            walker.closer.keyframes()[edge.to].T_map_camera;
        EXPECT_LT((edge.T_from_to.translation() - tracked.translation()).norm(), 1e-6);
    }
    EXPECT_TRUE(linked);
    const std::vector<StampedPose> path = walker.closer.Path();
    const Eigen::Isometry3d went =
        path[before].T_world_camera.inverse() * path[before + 1].T_world_camera;
    EXPECT_LT((went.translation() - true_step.translation()).norm(), 0.03);
}

}  // namespace
}  // namespace tessera
