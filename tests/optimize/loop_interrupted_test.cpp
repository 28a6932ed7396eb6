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
}

// A lost camera that sees the place where the walk began. Returns the keyframe there.
int SeeTheFirstPlace(const std::vector<Frame>& frames, double stamp_s, Walker& walker) {
    PreparedFrame prepared;
    PrepareFrame(frames[0], walker.settings.preparation, prepared);
    std::string note;
    const auto found = walker.closer.Relocalise(stamp_s, prepared, note);
    return found ? found->keyframe : -1;
}

// Between a lost camera's being seen and its being tracked there, the map in use is still being
// moved. What was fused before the loss must not follow the place where the camera is now.
TEST(LoopCloser, AMapThatIsMovedIsAskedForAgainIfTheCameraIsSeenElsewhere) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> frames = Round();
    for (const bool fused : {false, true}) {
        Walker walker(LoopConfig{});
        walker.moves_map = true;
        LoopCloser& closer = walker.closer;
        const std::size_t last = WalkUntilTheMapIsMadeAgain(frames, walker);
        ASSERT_TRUE(closer.MovesMap() && !closer.WantsMap());
        const double stamp_s = frames[last].stamp_s + 0.2;
        closer.Pass(stamp_s, walker.T_map_camera, fused);
        ASSERT_EQ(SeeTheFirstPlace(frames, stamp_s + 1, walker), 0);
        bool corrected = false;
        while (!corrected && closer.MovesMap() && !closer.WantsMap())
            corrected = closer.Step(20).has_value();
        EXPECT_EQ(corrected, !fused);
        EXPECT_EQ(closer.WantsMap(), fused);
    }
}

// It was seen at the first place, but not tracked there, and came back by itself.
TEST(LoopCloser, ACameraThatCameBackByItselfMovesWithWhereItIs) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> frames = Round();
    Walker walker(LoopConfig{});
    const std::size_t last = WalkUntilTheMapIsMadeAgain(frames, walker);
    ASSERT_EQ(walker.corrections, 0);
    Frame back = frames[last];
    ASSERT_EQ(SeeTheFirstPlace(frames, back.stamp_s + 1, walker), 0);
    const Eigen::Isometry3d T_before = walker.T_map_camera;
    back.stamp_s += 1;
    while (walker.corrections == 0 && walker.closer.HasWork()) {
        back.stamp_s += 0.2;
        walker.Go(back, Eigen::Isometry3d::Identity());
    }
    ASSERT_EQ(walker.corrections, 1);
    const Eigen::Isometry3d T_now = walker.closer.Path().back().T_world_camera;
    EXPECT_GT((T_now.translation() - T_before.translation()).norm(), 0.01);
    EXPECT_LT((T_now.translation() - walker.T_map_camera.translation()).norm(), 1e-6);
}

}  // namespace
}  // namespace tessera
