// Two scans of the furnished room, with Kinect noise, that are merged.
#include "run/scan_merge.h"

#include "run/run.h"
#include "run/scan_export.h"
#include "support/temp_folder.h"
#include "system/frame_list.h"
#include "system/lockstep_engine.h"

namespace tessera {
namespace {

using testing_support::FrameList;
using testing_support::RoomWalk;

class ScanMerge : public testing::Test {
  protected:
    ScanMerge() {
        config.loops.enabled = true;
        config.pipeline.map = {.voxel_size_m = 0.02, .truncation_m = 0.08};
        config.pipeline.trackers.sdf.finest_step_px = 1;
    }
    std::string ScanOf(const std::string& name, const std::vector<Frame>& frames,
                       double first_stamp_s = 0) {
        const std::string path = folder / name;
        EngineInput input;
        input.source = std::make_unique<FrameList>(frames, first_stamp_s);
        input.config = config;
        input.stop = &stop;
        Result<ScanPlan> plan = BeginScan(path, input.source->info(), config);
        EXPECT_TRUE(plan.ok()) << plan.message();
        input.scan = std::move(plan.value());
        LockstepEngine engine(std::move(input));
        FrameOutcome outcome;
        while (engine.Next(outcome)) {
        }
        EXPECT_TRUE(engine.status().ok()) << engine.status().message();
        return path;
    }

    RunConfig config;
    std::atomic<bool> stop{false};
    TempFolder folder;
};

TEST_F(ScanMerge, BothPathsLieInTheWorldOfTheFirst) {
    const std::vector<Frame> first = RoomWalk(0, 50, 3), second = RoomWalk(60, 50, 3);
    const std::string a = ScanOf("a.scan", first), b = ScanOf("b.scan", second, 100),
                      out = folder / "c.scan";
    const Result<MergeReport> merged = MergeScans(a, b, out);
    ASSERT_TRUE(merged.ok()) << merged.message();
    EXPECT_GE(merged.value().places, 2);
    EXPECT_GE(merged.value().overlaps, 2);
    EXPECT_FALSE(std::filesystem::exists(out + ".part"));
    Result<ScanContent> scan = ReadScan(out, {.map = true, .frames = true});
    ASSERT_TRUE(scan.ok()) << scan.message();
    const std::vector<StampedPose> path = scan.value().Path();
    ASSERT_EQ(path.size(), 100u);
    for (std::size_t i = 0; i < path.size(); ++i) {
        const Frame& frame = i < 50 ? first[i] : second[i - 50];
        EXPECT_LT(
            (path[i].T_world_camera.translation() - frame.T_world_camera->translation()).norm(),
            0.02)
            << i;
    }
    // The map is one from the frames of both: as many blocks as where both were fused at once.
    const BlockId alone_a = ReadScan(a, {}).value().map->size(),
                  alone_b = ReadScan(b, {}).value().map->size(), both = scan.value().map->size();
    EXPECT_GT(both, std::max(alone_a, alone_b));
    EXPECT_LT(both, alone_a + alone_b);
    EXPECT_EQ(scan.value().frames.size(),
              ReadScan(a, {.map = false, .frames = true}).value().frames.size() +
                  ReadScan(b, {.map = false, .frames = true}).value().frames.size());
    // It can be gone on with, after the second recording.
    const auto plan = ResumeScan(out, FrameList(second).info(), config, false);
    ASSERT_TRUE(plan.ok()) << plan.message();
    EXPECT_EQ(plan.value().resumed->progress.frames, 100);
}

TEST_F(ScanMerge, WhatCannotBeMergedIsRefusedAndLeavesNoFile) {
    const std::string a = ScanOf("a.scan", RoomWalk(0, 20, 3)),
                      elsewhere = ScanOf("e.scan", RoomWalk(360, 20, 3)), out = folder / "c.scan";
    EXPECT_NE(MergeScans(a, elsewhere, out).message().find("no common place"), std::string::npos);
    EXPECT_NE(MergeScans(a, folder / "none.scan", out).message().find("none.scan"),
              std::string::npos);
    config.loops.enabled = false;
    const std::string plain = ScanOf("plain.scan", RoomWalk(0, 5, 3));
    EXPECT_NE(MergeScans(a, plain, out).message().find("--loop-closure on"), std::string::npos);
    config.loops.enabled = true;
    config.pipeline.map.voxel_size_m = 0.03;
    const std::string coarse = ScanOf("coarse.scan", RoomWalk(0, 5, 3));
    EXPECT_NE(MergeScans(a, coarse, out).message().find("voxel_size_m"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(out));
    EXPECT_NE(MergeScans(a, coarse, plain).message().find("already exists"), std::string::npos);
}

}  // namespace
}  // namespace tessera
