// A camera that is lost for long begins a new part of the scan.
#include "system/loss_watch.h"

#include "optimize/scan_parts.h"
#include "system/engine_fixture.h"
#include "system/frame_list.h"
#include "system/loop_journal.h"

namespace tessera {
namespace {

using testing_support::FrameList;
using testing_support::RoomWalk;

TrackedFrame At(double stamp_s, TrackStatus status) {
    TrackedFrame tracked;
    tracked.prepared.valid_depth_pixels = 1;
    tracked.prepared.has_colour = true;
    tracked.report.stamp_s = stamp_s;
    tracked.report.track.status = status;
    return tracked;
}

constexpr TrackStatus kGood = TrackStatus::kGood, kLost = TrackStatus::kLost;

TEST(LossWatch, AfterFewFramesWaitsForASecondAndForAsManyFrames) {
    for (const int good : {1, 4, 10}) {
        LossWatch watch;
        for (int i = 0; i < good; ++i) watch.Add(At(i, kGood));
        for (int i = 1; i <= good; ++i) {
            EXPECT_FALSE(watch.anywhere()) << good;
            watch.Add(At(good - 1 + i, kLost));
        }
        EXPECT_TRUE(watch.anywhere()) << good;
        watch.Clear();
        EXPECT_FALSE(watch.anywhere());
        watch.Add(At(90, kLost));  // nothing has begun yet
        EXPECT_FALSE(watch.anywhere());
    }
    LossWatch watch;
    watch.Add(At(10, kGood));
    watch.Add(At(10.875, kLost));
    EXPECT_FALSE(watch.anywhere());
    watch.Add(At(11, kLost));
    EXPECT_TRUE(watch.anywhere());
}

TEST(LossWatch, LaterLooksForTwoSeconds) {
    LossWatch watch;
    for (int i = 0; i < 11; ++i) watch.Add(At(i, kGood));
    watch.Add(At(10.5, TrackStatus::kPoor));
    for (int i = 1; i < 8; ++i) {
        watch.Add(At(10.5 + 0.25 * i, kLost));
        EXPECT_FALSE(watch.anywhere()) << i;
    }
    watch.Add(At(12.5, kLost));
    EXPECT_TRUE(watch.anywhere());
    watch.Add(At(12.75, kGood));
    EXPECT_FALSE(watch.anywhere());
    // After a gap in time, too, it is looked for first.
    watch.Add(At(50, kLost));
    watch.Add(At(50.875, kLost));
    EXPECT_FALSE(watch.anywhere());
    watch.Add(At(51, kLost));
    EXPECT_TRUE(watch.anywhere());
}

TEST(LossWatch, ACoveredCameraHasNothingToBeginWith) {
    LossWatch watch;
    watch.Add(At(0, kGood));
    for (const bool colour : {false, true}) {
        TrackedFrame covered = At(5, kLost);
        (colour ? covered.prepared.valid_depth_pixels = 0 : covered.prepared.has_colour = false);
        watch.Add(covered);
        EXPECT_FALSE(watch.anywhere());
    }
    watch.Add(At(5.125, kLost));
    EXPECT_TRUE(watch.anywhere());
    watch.Add(At(5.25, TrackStatus::kPoor));  // it may find its way
    EXPECT_FALSE(watch.anywhere());
}

class LostCameraRun : public EngineTest {
  protected:
    void Make(bool live, std::vector<Frame> frames, const std::string& scan = {}) {
        config.live = {};
        config.live.queue_frames = 200;
        EngineInput input = Input({});
        input.source = std::make_unique<FrameList>(std::move(frames));
        if (!scan.empty()) {
            Result<ScanPlan> plan = BeginScan(scan, input.source->info(), config);
            ASSERT_TRUE(plan.ok()) << plan.message();
            input.scan = std::move(plan.value());
        }
        if (live)
            engine = std::make_unique<LiveEngine>(std::move(input));
        else
            engine = std::make_unique<LockstepEngine>(std::move(input));
        TakeAll();
    }
    // Frames of one place, then `count` of another.
    static std::vector<Frame> Kidnapped(int first, int count) {
        std::vector<Frame> frames = RoomWalk(0, first, 1);
        for (Frame& frame : RoomWalk(200, count, 1)) frames.push_back(std::move(frame));
        return frames;
    }
};

class LostStart : public LostCameraRun, public testing::WithParamInterface<bool> {};

// Two frames of one place, then two seconds of another, which is the scan in the end.
TEST_P(LostStart, BeginsAgain) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    Make(GetParam(), Kidnapped(2, 60));
    EXPECT_NE(Messages().find("2 frames are left out"), std::string::npos) << Messages();
    const auto reports = Reports();
    ASSERT_EQ(reports.size(), 62u);
    EXPECT_FALSE(reports[10]->tracked());
    EXPECT_TRUE(reports.back()->fused) << reports.back()->track.reason;
    const auto first = std::ranges::find_if(reports.begin() + 1, reports.end(),
                                            [](const FrameReport* r) { return r->first; });
    ASSERT_NE(first, reports.end());
    EXPECT_NE((*first)->warning.find(kPartBegins), std::string::npos) << (*first)->warning;
    EXPECT_NEAR((*first)->stamp_s - reports[1]->stamp_s, 1 + 1.0 / 30, 0.05);
    // The other place has the only map, and its first camera is the world's.
    const std::vector<StampedPose> path = engine->CorrectedPath();
    EXPECT_EQ(std::ssize(path), reports.end() - first);
    ASSERT_FALSE(path.empty());
    EXPECT_LT(path.back().T_world_camera.translation().norm(), 2);
    EXPECT_GT(engine->map_statistics().blocks, 100);
    for (const auto& vertex : engine->TakeMesh().vertices) ASSERT_LT(vertex.norm(), 20);
}
// What is exported from the file is what the run has written. A later session has the rest.
TEST_P(LostStart, AScanFileDoesNotShowWhatWasLeftOut) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const TempFolder folder;
    const std::string path = folder / "a.scan";
    ASSERT_NO_FATAL_FAILURE(Make(GetParam(), Kidnapped(2, 60), path));
    const std::vector<StampedPose> kept = engine->CorrectedPath();
    ASSERT_FALSE(kept.empty());
    const std::int64_t blocks = engine->map_statistics().blocks;
    engine.reset();
    Result<ScanContent> scan = ReadScan(path, {.map = true, .frames = true});
    ASSERT_TRUE(scan.ok()) << scan.message();
    EXPECT_EQ(scan.value().map->count(), blocks);
    const std::vector<StampedPose> stored = scan.value().Path();
    ASSERT_EQ(stored.size(), kept.size());
    for (std::size_t i = 0; i < kept.size(); ++i) {
        EXPECT_EQ(stored[i].stamp_s, kept[i].stamp_s);
        EXPECT_TRUE(stored[i].T_world_camera.isApprox(kept[i].T_world_camera, 1e-6)) << i;
    }
    EXPECT_EQ(TakeLoopMemory(scan.value()).graph.passages.size(), kept.size() + 2);
}

INSTANTIATE_TEST_SUITE_P(Engines, LostStart, testing::Bool());

// The camera walks back to where it was before.
std::vector<Frame> ThereAndBack() {
    std::vector<Frame> frames = RoomWalk(0, 12, 8);
    frames.insert(frames.end(), 61, RoomWalk(200, 1, 1)[0]);
    for (Frame& frame : RoomWalk(200, 49, -4)) frames.push_back(std::move(frame));
    return frames;
}

TEST_F(LostCameraRun, TheNewPartIsJoinedWithTheRest) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const std::vector<Frame> frames = ThereAndBack();
    Make(false, frames);
    const auto reports = Reports();
    const auto told = [&](const char* what) {
        return std::ranges::any_of(reports, [what](const FrameReport* r) {
            return r->warning.find(what) != std::string::npos;
        });
    };
    EXPECT_FALSE(reports.front()->begins_part);
    EXPECT_EQ(std::ranges::count_if(reports, &FrameReport::begins_part), 1);
    EXPECT_TRUE(told("is joined with"));
    EXPECT_TRUE(told("map corrected"));
    EXPECT_EQ(Messages().find("left out"), std::string::npos) << Messages();
    const std::vector<StampedPose> path = engine->CorrectedPath();
    ASSERT_EQ(path.size(), 12u + 50);
    for (std::size_t i = 0; i < path.size(); ++i)
        EXPECT_LT((path[i].T_world_camera.translation() -
                   frames[i + (i < 12 ? 0 : 60)].T_world_camera->translation())
                      .norm(),
                  0.02)
            << i;
    for (const auto& vertex : engine->TakeMesh().vertices) ASSERT_LT(vertex.norm(), 20);
}

TEST_F(LostCameraRun, ALostCameraIsNotLookedForWhereThatWasSwitchedOffBeforeAReset) {
    ViewerLink link;
    viewer = &link;
    const auto found = [&](bool loops) {
        std::vector<Frame> frames = RoomWalk(0, 30, 3);
        frames.insert(frames.end(), 45, testing_support::Blank());
        frames.insert(frames.end(), 3, frames.front());
        ViewerSettings settings;
        settings.loops = loops;
        link.settings.Push(std::move(settings));
        Ask(Command::kReset);
        outcomes.clear();
        Make(false, std::move(frames));
        return std::ranges::any_of(Reports(), [](const FrameReport* r) {
            return r->warning.find("relocalised at") != std::string::npos;
        });
    };
    EXPECT_TRUE(found(true));
    EXPECT_FALSE(found(false));
}

// The first part is paged out while the other is seen.
TEST_F(LostCameraRun, PartsAreTheSameWithAMemoryLimit) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    const TempFolder folder;
    struct Made {
        std::vector<StampedPose> path;
        TriangleMesh mesh;
        std::int64_t most_blocks = 0;
    };
    const auto run = [&](const std::string& name) {
        outcomes.clear();
        Make(false, ThereAndBack(), folder / name);
        Made made{engine->CorrectedPath(), engine->TakeMesh()};
        for (const FrameOutcome& outcome : outcomes)
            made.most_blocks = std::max(made.most_blocks, outcome.map.blocks);
        engine.reset();
        return made;
    };
    const Made whole = run("whole.scan");
    config.pipeline.memory_limit_mb = 10;  // what one view needs
    const Made paged = run("paged.scan");
    EXPECT_LT(4 * paged.most_blocks, 3 * whole.most_blocks);
    ASSERT_EQ(paged.path.size(), whole.path.size());
    for (std::size_t i = 0; i < whole.path.size(); ++i)
        EXPECT_EQ(paged.path[i].T_world_camera.matrix(), whole.path[i].T_world_camera.matrix())
            << i;
    EXPECT_TRUE(paged.mesh.vertices == whole.mesh.vertices);
    EXPECT_TRUE(paged.mesh.colours == whole.mesh.colours);
    EXPECT_TRUE(paged.mesh.triangles == whole.mesh.triangles);
}

TEST_F(LostCameraRun, BeginsNoPartWhereItIsOffOrCannotBe) {
    const auto parts = [this] {
        outcomes.clear();
        Make(false, Kidnapped(2, 40));
        const auto reports = Reports();
        return std::ranges::count_if(reports, [](const FrameReport* r) { return r->first; });
    };
    EXPECT_EQ(parts(), PoseGraphAvailable() ? 2 : 1);
    const RunConfig on = config;
    config.loops.parts = false;
    EXPECT_EQ(parts(), 1);
    config = on;
    config.loops.enabled = false;
    EXPECT_EQ(parts(), 1);
    config = on;
    config.pipeline.fusion.volume.bounded = true;
    EXPECT_EQ(parts(), 1);
}

}  // namespace
}  // namespace tessera
