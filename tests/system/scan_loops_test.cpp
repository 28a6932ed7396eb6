// Scans with loop closure that are saved and gone on with, in a rendered room with a Kinect's noise.
#include <cstring>

#include "support/temp_folder.h"
#include "system/frame_list.h"
#include "system/lockstep_engine.h"

namespace tessera {
namespace {

using testing_support::FrameList;
using testing_support::RoomWalk;

class ScanLoops : public testing::Test {
  protected:
    ScanLoops() {
        config.loops.enabled = true;
        config.pipeline.map = {.voxel_size_m = 0.02, .truncation_m = 0.08};
        config.pipeline.trackers.sdf.finest_step_px = 1;
    }
    std::vector<FrameReport> Run(const std::vector<Frame>& frames, double first_stamp_s, bool resume) {
        EngineInput input;
        input.source = std::make_unique<FrameList>(frames, first_stamp_s);
        input.config = config;
        input.stop = &stop;
        Result<ScanPlan> plan = resume ? ResumeScan(path, input.source->info(), config, false)
                                       : BeginScan(path, input.source->info(), config);
        EXPECT_TRUE(plan.ok()) << plan.message();
        input.scan = std::move(plan.value());
        LockstepEngine engine(std::move(input));
        FrameOutcome outcome;
        std::vector<FrameReport> reports;
        while (engine.Next(outcome))
            if (outcome.kind == FrameOutcome::Kind::kFrame) reports.push_back(outcome.report);
        EXPECT_TRUE(engine.status().ok()) << engine.status().message();
        corrected = engine.CorrectedPath();
        return reports;
    }

    RunConfig config;
    const std::atomic<bool> stop{false};
    TempFolder folder;
    std::string path = folder / "a.scan";
    std::vector<StampedPose> corrected;
};

TEST_F(ScanLoops, KeyframesFramesAndLoopsComeBackAndALostCameraIsFoundByThem) {
    const std::vector<Frame> walk = RoomWalk(0, 60, 3);
    Run(walk, 0, false);
    const std::vector<StampedPose> before = corrected;
    Result<ScanContent> scan = ReadScan(path, {.map = false, .frames = true});
    ASSERT_TRUE(scan.ok()) << scan.message();
    EXPECT_GT(scan.value().keyframes.size(), 3u);
    EXPECT_EQ(scan.value().loops.edges.size() >= scan.value().keyframes.size() - 1, true);
    EXPECT_EQ(scan.value().frames.size(), 60u);
    const std::vector<StampedPose> stored = scan.value().Path();
    ASSERT_EQ(stored.size(), before.size());
    for (std::size_t i = 0; i < stored.size(); ++i)
        EXPECT_EQ(stored[i].T_world_camera.matrix(), before[i].T_world_camera.matrix()) << i;
    // Ten seconds later the camera sees what it saw at the beginning, not at the end.
    const std::vector<Frame> again = RoomWalk(21, 10, 1);
    const std::vector<FrameReport> reports = Run(again, 12, true);
    ASSERT_EQ(reports.size(), again.size());
    EXPECT_TRUE(reports[0].tracked()) << reports[0].track.reason;
    for (std::size_t i = 0; i < reports.size(); ++i) {
        const Eigen::Isometry3d off = again[i].T_world_camera->inverse() * reports[i].track.T_world_camera;
        EXPECT_LT(off.translation().norm(), 0.02) << i;
    }
    EXPECT_EQ(corrected.size(), before.size() + reports.size());  // the path of the whole scan
}

TEST_F(ScanLoops, WhereNothingWasSeenTheCameraStaysLostAndTheMapAsItWas) {
    Run(RoomWalk(0, 20, 2), 0, false);
    const Result<ScanContent> before = ReadScan(path, {});
    const std::vector<FrameReport> reports = Run(RoomWalk(360, 5, 2), 12, true);
    for (const FrameReport& report : reports) EXPECT_FALSE(report.tracked());
    const Result<ScanContent> after = ReadScan(path, {});
    ASSERT_TRUE(before.ok() && after.ok());
    ASSERT_EQ(after.value().map->size(), before.value().map->size());
    for (BlockId id = 1; id < after.value().map->size(); ++id)
        ASSERT_EQ(std::memcmp(after.value().map->field(id), before.value().map->field(id), kBlockVoxels * sizeof(FieldWord)), 0);
}

}  // namespace
}  // namespace tessera
