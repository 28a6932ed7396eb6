// What becomes of frames and poses while a map is made again, and of the corrected map.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstddef>
#include <string>
#include <vector>

#include "optimize/drifting_walk.h"
#include "optimize/loop_closer.h"
#include "optimize/room_walk.h"

namespace tessera {
namespace {

using testing_support::Bias;
using testing_support::EndError_m;
using testing_support::Round;
using testing_support::Walker;
using testing_support::WalkWithDrift;

// Of a map from another, near the other's surface.
struct Difference {
    double mean_m = 0;
    int known = 0, missing = 0;
    double weight = 0;  // a share of the other's, in what both know
};
Difference DifferenceOf(const BlockMap& map, const BlockMap& other) {
    Difference all;
    double weight = 0;
    for (BlockId id = 1; id < other.size(); ++id) {
        const BlockId same = map.Find(other.coord(id));
        for (int v = 0; v < kBlockVoxels; ++v) {
            const FieldWord there = other.field(id)[v], here = map.field(same)[v];
            if (!HasDistance(there) || std::abs(FieldDistance(there)) > 0.25f) continue;
            HasDistance(here) ? ++all.known : ++all.missing;
            if (!HasDistance(here)) continue;
            all.mean_m +=
                std::abs(FieldDistance(there) - FieldDistance(here)) * map.config().truncation_m;
            all.weight += map.weight(same)[v];
            weight += other.weight(id)[v];
        }
    }
    all.mean_m /= all.known;
    all.weight /= weight;
    return all;
}

// If a map holds a surface twice, tracking can jump from one copy to the other.
TEST(LoopCloser, AJumpWhileTheMapIsMadeAgainIsNoMotion) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> frames = Round();
    Walker walker(LoopConfig{});
    std::size_t jumped = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
        if (i > 0)
            step = frames[i - 1].T_world_camera->inverse() * *frames[i].T_world_camera * Bias();
        if (jumped == 0 && walker.closer.HasWork()) {
            step = step * Eigen::Translation3d(0.08, 0, 0);
            jumped = i;
        }
        walker.Go(frames[i], step);
    }
    ASSERT_GT(jumped, 0u);
    const std::vector<StampedPose> path = walker.closer.Path();
    const Eigen::Isometry3d went =
        path[jumped - 1].T_world_camera.inverse() * path[jumped].T_world_camera;
    const Eigen::Isometry3d true_step =
        frames[jumped - 1].T_world_camera->inverse() * *frames[jumped].T_world_camera;
    EXPECT_LT((went.translation() - true_step.translation()).norm(), 0.03);
}

// An image that is too wide for a JPEG is not stored. Its keyframes are still connected to those of
// the rebuilt map.
TEST(LoopCloser, FramesThatCannotBeStoredWhileTheMapIsMadeAgainAreTold) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> frames = Round();
    Walker walker(LoopConfig{});
    int keyframes_lost = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
        if (i > 0)
            step = frames[i - 1].T_world_camera->inverse() * *frames[i].T_world_camera * Bias();
        Frame wide = frames[i];
        wide.colour.Resize(70000, 1);
        const bool lost = walker.closer.HasWork();
        const int before = walker.closer.keyframes().size();
        walker.Go(frames[i], step, lost ? &wide : nullptr);
        if (lost) keyframes_lost += walker.closer.keyframes().size() - before;
    }
    EXPECT_GT(keyframes_lost, 0);
    EXPECT_NE(walker.all_news.find("cannot be encoded as JPEG"), std::string::npos)
        << walker.all_news;
    std::string note;
    walker.Take(walker.closer.Finish(note));
    EXPECT_EQ(walker.closer.Path().size(), frames.size());
    EXPECT_LT(EndError_m(frames, walker.closer.Path()), 0.07);
}

// Also the latest ones, which are not stored yet because their average is not complete: while the
// map is made again, the camera stands still.
TEST(LoopCloser, ACorrectedMapHasEveryFrame) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> frames = Round();
    Walker walker(LoopConfig{});
    int gone = 0;
    for (std::size_t i = 0; i < frames.size() && walker.corrections == 0; ++i) {
        Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
        if (i > 0)
            step = frames[i - 1].T_world_camera->inverse() * *frames[i].T_world_camera * Bias();
        walker.Go(frames[i], step);
        ++gone;
        while (walker.corrections == 0 && walker.closer.HasWork()) {
            walker.Go(frames[i], Eigen::Isometry3d::Identity());
            ++gone;
        }
    }
    EXPECT_EQ(walker.corrections, 1);
    float weight = 0;
    for (const StoredFrame& stored : walker.closer.store().frames()) weight += stored.view.weight;
    EXPECT_FLOAT_EQ(weight, static_cast<float>(gone));
}

// The latest frames cannot be stored: the map is corrected without them.
TEST(LoopCloser, AMapIsCorrectedWithoutFramesThatCannotBeStored) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> frames = Round();
    Walker walker(LoopConfig{});
    for (std::size_t i = 0; i < frames.size() && walker.corrections == 0; ++i) {
        Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
        if (i > 0)
            step = frames[i - 1].T_world_camera->inverse() * *frames[i].T_world_camera * Bias();
        walker.Go(frames[i], step);
        Frame wide = frames[i];
        wide.colour.Resize(70000, 1);
        // A new average begins after 6 cm.
        for (double away_m = 0.06; walker.corrections == 0 && walker.closer.HasWork(); away_m = 0)
            walker.Go(frames[i], Eigen::Isometry3d(Eigen::Translation3d(away_m, 0, 0)), &wide);
    }
    EXPECT_EQ(walker.corrections, 1);
}

// The map that was moved, and in part fused again, shows the same surface as one of all frames.
TEST(LoopCloser, AMapMovedAtTheEndIsLikeOneFusedAgain) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> frames = Round();
    std::unique_ptr<BlockMap> maps[2];
    std::unique_ptr<BlockMap> before;
    for (const bool moved : {false, true}) {
        Walker walker(LoopConfig{});
        WalkWithDrift(frames, walker, 0.3);
        ASSERT_EQ(walker.corrections, 0);
        std::string note;
        int freed = 0;
        auto correction =
            walker.closer.Finish(note, moved ? walker.map.get() : nullptr, [&freed] { ++freed; });
        ASSERT_TRUE(correction.has_value());
        EXPECT_EQ(freed, moved ? 0 : 1);
        maps[moved] = std::move(correction->map);
        before = std::move(walker.map);
    }
    const Difference moved = DifferenceOf(*maps[1], *maps[0]),
                     not_moved = DifferenceOf(*before, *maps[0]);
    EXPECT_LT(moved.mean_m, 0.003);
    EXPECT_GT(not_moved.mean_m, 0.01);
    EXPECT_GT(moved.known, 100000);
    EXPECT_LT(moved.missing, 0.01 * moved.known);
}

// The map in use is moved during the run. What was fused meanwhile follows: here the camera stands
// still until the map is corrected.
TEST(LoopCloser, AMapMovedDuringTheRunHasEveryFrame) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> frames = Round();
    Walker walker(LoopConfig{});
    walker.moves_map = true;
    std::vector<const Frame*> gone;
    std::size_t before = 0;  // frames when the map in use was given
    for (std::size_t i = 0; i < frames.size() && walker.corrections == 0; ++i) {
        Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
        if (i > 0)
            step = frames[i - 1].T_world_camera->inverse() * *frames[i].T_world_camera * Bias();
        walker.Go(frames[i], step);
        gone.push_back(&frames[i]);
        before = gone.size();
        while (walker.corrections == 0 && walker.closer.HasWork()) {
            walker.Go(frames[i], Eigen::Isometry3d::Identity());
            gone.push_back(&frames[i]);
        }
    }
    ASSERT_EQ(walker.corrections, 1);
    EXPECT_GT(gone.size(), before + 5);
    BlockMap fresh(walker.settings.map);
    for (std::size_t i = 0; i < gone.size(); ++i) {
        const PathPose& pose = walker.closer.graph().passages()[i];
        PreparedFrame prepared;
        PrepareFrame(*gone[i], walker.settings.preparation, prepared);
        Integrator::View view;
        view.T_world_camera =
            walker.closer.keyframes()[pose.keyframe].T_map_camera * pose.T_keyframe_camera;
        walker.integrator.Integrate(prepared, view, fresh);
    }
    const Difference moved = DifferenceOf(*walker.map, fresh);
    EXPECT_LT(moved.mean_m, 0.007);  // the walk ends 8 cm off, as far as the band reaches
    EXPECT_GT(moved.known, 100000);
    EXPECT_LT(moved.missing, 0.02 * moved.known);
    EXPECT_NEAR(moved.weight, 1, 0.02);
}

TEST(LoopCloser, CorrectsToTheSameBytesForAnyNumberOfThreads) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> frames = Round();
    std::vector<StampedPose> paths[2];
    for (const int threads : {1, 3}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                        static_cast<std::size_t>(threads));
        Walker walker(LoopConfig{});
        WalkWithDrift(frames, walker);
        std::string note;
        walker.Take(walker.closer.Finish(note));
        EXPECT_GE(walker.corrections, 1);
        paths[threads / 2] = walker.closer.Path();
    }
    ASSERT_EQ(paths[0].size(), paths[1].size());
    for (std::size_t i = 0; i < paths[0].size(); ++i)
        EXPECT_EQ(paths[0][i].T_world_camera.matrix(), paths[1][i].T_world_camera.matrix()) << i;
}

}  // namespace
}  // namespace tessera
