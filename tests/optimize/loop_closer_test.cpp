// Complete walks through a rendered room with Kinect noise.
#include "optimize/loop_closer.h"

#include <tbb/global_control.h>

#include <algorithm>

#include "optimize/room_walk.h"

namespace tessera {
namespace {

using testing_support::RoomCamera;
using testing_support::RoomWalk;
using testing_support::Walker;

// One full turn and a little more, every sixth frame.
std::vector<Frame> Round() { return RoomWalk(0, 120, 6); }

// Odometry error between two frames: 1.5 mm and 0.05 degrees, always in the same direction.
Eigen::Isometry3d Bias() { return Se3Exp((Vector6d() << 0, 0.0009, 0, 0.0015, 0, 0).finished()); }

void WalkWithDrift(const std::vector<Frame>& frames, Walker& walker) {
    for (std::size_t i = 0; i < frames.size(); ++i)
        walker.Go(frames[i], i == 0 ? Eigen::Isometry3d::Identity()
                                    : frames[i - 1].T_world_camera->inverse() *
                                          *frames[i].T_world_camera * Bias());
}

double EndError_m(const std::vector<Frame>& frames, const std::vector<StampedPose>& path) {
    return (path.back().T_world_camera.translation() - frames.back().T_world_camera->translation())
        .norm();
}

TEST(LoopCloser, TakesAFifthOrLessOfTheDriftToTheEndAndTheMapFollows) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> frames = Round();
    LoopConfig off;
    off.min_votes = 1000;  // too many votes for any candidate, so no loops
    off.overlaps = false;
    Walker without(off), with(LoopConfig{});
    WalkWithDrift(frames, without);
    WalkWithDrift(frames, with);
    std::string note;
    with.Take(with.closer.Finish(note));
    EXPECT_EQ(note, "");
    const double before_m = EndError_m(frames, without.closer.Path()),
                 after_m = EndError_m(frames, with.closer.Path());
    RecordProperty("before_mm", std::to_string(1000 * before_m));
    RecordProperty("after_mm", std::to_string(1000 * after_m));
    std::cout << "end-point error " << 1000 * before_m << " mm without, " << 1000 * after_m
              << " mm with; " << with.closer.loops() << " loops, " << with.closer.keyframes().size()
              << " keyframes\n"
              << with.all_news;
    EXPECT_GT(before_m, 0.07);
    EXPECT_LE(after_m, before_m / 5);
    EXPECT_GE(with.corrections, 1);
    EXPECT_EQ(without.corrections, 0);

    // Compare the map with a fresh fusion of the original frames at the final poses.
    BlockMap fresh(with.settings.map);
    Integrator integrator(with.settings.fusion, RoomCamera());
    const std::vector<StampedPose> path = with.closer.Path();
    ASSERT_EQ(path.size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        PreparedFrame prepared;
        PrepareFrame(frames[i], with.settings.preparation, prepared);
        Integrator::View view;
        view.T_world_camera = path[i].T_world_camera;
        integrator.Integrate(prepared, view, fresh);
    }
    std::vector<float> off_voxels;
    const float voxels =
        static_cast<float>(with.settings.map.truncation_m / with.settings.map.voxel_size_m);
    for (BlockId id = 1; id < fresh.size(); ++id) {
        const BlockId other = with.map->Find(fresh.coord(id));
        for (int v = 0; v < kBlockVoxels && other != kUnknownBlock; ++v)
            if (HasDistance(fresh.field(id)[v]) && HasDistance(with.map->field(other)[v]) &&
                std::abs(FieldDistance(fresh.field(id)[v])) < 0.5f)
                off_voxels.push_back(voxels * std::abs(FieldDistance(fresh.field(id)[v]) -
                                                       FieldDistance(with.map->field(other)[v])));
    }
    ASSERT_GT(off_voxels.size(), 10000u);
    std::ranges::sort(off_voxels);
    const float p95 = off_voxels[off_voxels.size() * 95 / 100];
    std::cout << "map against a fresh fusion: 95th percentile " << p95 << " voxels\n";
    EXPECT_LE(p95, 0.5f);
}

// Tracking drifts by half a metre and ten degrees, which is more than a walk of 4 m explains,
// from frame `first` on in so many steps.
void ExpectALargeDriftIsClosed(int first, int steps) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> frames = Round();
    Walker walker(LoopConfig{});
    const auto drifted = [&](std::size_t i) {
        const double share = std::clamp((static_cast<double>(i) - first) / steps, 0.0, 1.0);
        const Vector6d drift = (Vector6d() << 0, 0.1745, 0, 0.3, 0.1, 0.39).finished() * share;
        return Normalised(Se3Exp(drift) * *frames[i].T_world_camera);
    };
    for (std::size_t i = 0; i < frames.size(); ++i)
        walker.Go(frames[i],
                  i == 0 ? Eigen::Isometry3d::Identity() : drifted(i - 1).inverse() * drifted(i));
    std::string note;
    walker.Take(walker.closer.Finish(note));
    const double before_m = (drifted(frames.size() - 1).translation() -
                             frames.back().T_world_camera->translation())
                                .norm(),
                 after_m = EndError_m(frames, walker.closer.Path());
    std::cout << "end-point error " << 1000 * before_m << " mm without, " << 1000 * after_m
              << " mm with\n"
              << walker.all_news;
    EXPECT_GT(before_m, 0.45);
    EXPECT_LE(after_m, 0.02);
    EXPECT_GE(walker.corrections, 1);
}

TEST(LoopCloser, FindsAndClosesALargeSlip) { ExpectALargeDriftIsClosed(60, 10); }

// Each alignment with a neighbour then contradicts tracking.
TEST(LoopCloser, FindsAndClosesALargeSteadyDrift) { ExpectALargeDriftIsClosed(0, 119); }

TEST(LoopCloser, SwitchedOffItClosesNothingUntilItIsOnAgain) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> frames = Round();
    for (const bool on_again : {false, true}) {
        Walker walker(LoopConfig{});
        walker.closer.SetSeeking(false);
        const auto step = [&](std::size_t i) {
            return Eigen::Isometry3d(frames[i - 1].T_world_camera->inverse() *
                                     *frames[i].T_world_camera * Bias());
        };
        for (std::size_t i = 0; i < frames.size(); ++i) {
            EXPECT_FALSE(walker.closer.HasWork());
            walker.Go(frames[i], i == 0 ? Eigen::Isometry3d::Identity() : step(i));
        }
        EXPECT_EQ(walker.corrections, 0);
        walker.closer.SetSeeking(on_again);
        for (std::size_t i = 1; i < 30; ++i) walker.Go(frames[i], step(i));
        std::string note;
        walker.Take(walker.closer.Finish(note));
        EXPECT_EQ(walker.corrections > 0, on_again);
        EXPECT_EQ(walker.closer.loops() > 0, on_again);
    }
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

// Loops between keyframes in different rooms, which are 6 m apart.
int FalseLoops(const LoopCloser& closer) {
    return static_cast<int>(std::ranges::count_if(closer.edges(), [&](const PoseEdge& edge) {
        const Eigen::Isometry3d &a = closer.keyframes()[edge.from].T_map_camera,
                                &b = closer.keyframes()[edge.to].T_map_camera;
        return edge.loop && (a.translation() - b.translation()).norm() > 3;
    }));
}

// The second room repeats the images of the first one. Only the path between them distinguishes
// them.
TEST(LoopCloser, TwoIdenticalRoomsAreNotOne) {
    const std::vector<Frame> frames = RoomWalk(0, 20, 6);
    for (const double max_drift : {0.05, 10.0}) {
        LoopConfig config;
        config.max_drift = max_drift;
        config.min_gap = 2;
        Walker walker(config);
        for (int room = 0; room < 2; ++room)
            for (std::size_t i = 0; i < frames.size(); ++i)
                walker.Go(frames[i], i > 0 ? frames[i - 1].T_world_camera->inverse() *
                                                 *frames[i].T_world_camera
                                     : room == 0 ? Eigen::Isometry3d::Identity()
                                                 : frames.back().T_world_camera->inverse() *
                                                       Eigen::Translation3d(6, 0, 0));
        if (max_drift < 1)
            EXPECT_EQ(FalseLoops(walker.closer), 0) << walker.all_news;
        else
            EXPECT_GT(FalseLoops(walker.closer) + walker.corrections, 0)
                << "without the gate there must be false loops";
        if (max_drift > 1) continue;
        // After a tracking loss the camera could be in either room.
        PreparedFrame prepared;
        PrepareFrame(frames[8], walker.settings.preparation, prepared);
        std::string note;
        EXPECT_FALSE(walker.closer.Relocalise(prepared, note).has_value());
        EXPECT_NE(note.find("ambiguous"), std::string::npos) << note;
    }
}

TEST(LoopCloser, FindsALostCameraToTheCentimetreAndRefusesAnUnknownPlace) {
    const std::vector<Frame> seen = RoomWalk(0, 30, 6);
    Walker walker(LoopConfig{});
    for (std::size_t i = 0; i < seen.size(); ++i)
        walker.Go(seen[i], i == 0
                               ? Eigen::Isometry3d::Identity()
                               : seen[i - 1].T_world_camera->inverse() * *seen[i].T_world_camera);
    std::string note;
    PreparedFrame prepared;
    int found = 0;
    for (const Frame& frame : RoomWalk(15, 5, 24)) {
        PrepareFrame(frame, walker.settings.preparation, prepared);
        const auto T_map_camera = walker.closer.Relocalise(prepared, note);
        if (!T_map_camera) continue;
        ++found;
        EXPECT_LT((T_map_camera->translation() - frame.T_world_camera->translation()).norm(), 0.015)
            << frame.index;
    }
    EXPECT_GE(found, 4);
    for (const Frame& frame : RoomWalk(360, 5, 24)) {  // the other side of the room
        PrepareFrame(frame, walker.settings.preparation, prepared);
        EXPECT_FALSE(walker.closer.Relocalise(prepared, note).has_value()) << frame.index;
    }
}

TEST(DriftOf, GrowsWithTheWay) {
    Keyframe old, fresh;
    fresh.T_world_camera = Eigen::Translation3d(1, 0, 0);
    fresh.path_length_m = 10;
    const Eigen::Isometry3d measured(Eigen::Translation3d(0.4, 0, 0));
    EXPECT_DOUBLE_EQ(DriftOf(old, fresh, measured, 0.05).off_m, 0.6);
    EXPECT_TRUE(DriftOf(old, fresh, measured, 0.05).possible);  // 0.15 + 0.05 * 10
    EXPECT_FALSE(DriftOf(old, fresh, measured, 0.04).possible);
    const Eigen::Isometry3d turned = measured * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX());
    EXPECT_FALSE(DriftOf(old, fresh, turned, 0.05).possible);
    fresh.turned_rad = 2;
    EXPECT_TRUE(DriftOf(old, fresh, turned, 0.05).possible);
    // A metre is neither: rooms of one kind lie farther apart than what is conceivable.
    const Eigen::Isometry3d half(Eigen::Translation3d(0.3, 0, 0)),
        metre(Eigen::Translation3d(-0.4, 0, 0));
    EXPECT_FALSE(DriftOf(old, fresh, half, 0.05).possible);
    EXPECT_TRUE(DriftOf(old, fresh, half, 0.05).conceivable);
    EXPECT_FALSE(DriftOf(old, fresh, metre, 0.05).conceivable);  // 1.4 m > 0.8 + 0.05 * 10
}

}  // namespace
}  // namespace tessera
