// Scans with loop closure that are saved and resumed, in a rendered room with Kinect noise.
#include <cstring>
#include <fstream>
#include <iterator>

#include "support/temp_folder.h"
#include "system/frame_list.h"
#include "system/live_engine.h"
#include "system/lockstep_engine.h"

namespace tessera {
namespace {

using testing_support::FrameList;
using testing_support::RoomWalk;

std::string FileBytes(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// The parameter selects live mode.
class ScanLoops : public testing::TestWithParam<bool> {
  protected:
    ScanLoops() {
        // Overload is not tested here: no frame is dropped, all are fused, and the thread that
        // closes loops keeps up, even on a machine that is busy with other work.
        config.live.queue_frames = 100;
        config.live.playback_speed = 0.1;
        config.loops.enabled = true;
        config.pipeline.map = {.voxel_size_m = 0.02, .truncation_m = 0.08};
        config.pipeline.trackers.sdf.finest_step_px = 1;
    }
    enum class Use { kBegin, kResume, kLocalise };

    std::vector<FrameReport> Run(const std::vector<Frame>& frames, double first_stamp_s, Use use) {
        EngineInput input;
        input.source = std::make_unique<FrameList>(frames, first_stamp_s);
        input.config = config;
        input.stop = &stop;
        const SourceInfo& source = input.source->info();
        Result<ScanPlan> plan = use == Use::kBegin    ? BeginScan(path, source, config)
                                : use == Use::kResume ? ResumeScan(path, source, config, false)
                                                      : OpenToLocalise(path, source, config);
        EXPECT_TRUE(plan.ok()) << plan.message();
        input.scan = std::move(plan.value());
        std::unique_ptr<Engine> engine;
        if (GetParam())
            engine = std::make_unique<LiveEngine>(std::move(input));
        else
            engine = std::make_unique<LockstepEngine>(std::move(input));
        FrameOutcome outcome;
        std::vector<FrameReport> reports;
        while (engine->Next(outcome)) {
            if (outcome.kind != FrameOutcome::Kind::kFrame) continue;
            reports.push_back(outcome.report);
            if (stop_when_tracked && outcome.report.tracked()) stop.store(true);
            if (reports.size() == look_after) early = ReadScan(path, {.map = true, .frames = true});
        }
        EXPECT_TRUE(engine->status().ok()) << engine->status().message();
        corrected = engine->CorrectedPath();
        map_blocks = static_cast<BlockId>(engine->map_statistics().blocks);
        return reports;
    }

    RunConfig config;
    std::atomic<bool> stop{false};
    bool stop_when_tracked = false;
    TempFolder folder;
    std::string path = folder / "a.scan";
    std::vector<StampedPose> corrected;
    BlockId map_blocks = 0;
    std::size_t look_after = 0;  // frames after which the file is read during the run
    Result<ScanContent> early = Status::Error("not read");
};

TEST_P(ScanLoops, KeyframesFramesAndLoopsComeBackAndALostCameraIsFoundByThem) {
    const std::vector<Frame> walk = RoomWalk(0, 60, 3);
    config.scan.interval_s = 0.1;
    look_after = 40;
    Run(walk, 0, Use::kBegin);
    // After a crash at any time the file holds the whole path and the state of loop closure.
    ASSERT_TRUE(early.ok()) << early.message();
    EXPECT_GT(early.value().path.size(), 10u);
    EXPECT_GT(early.value().keyframes.size(), 1u);
    EXPECT_GT(early.value().frames.size(), 5u);
    for (const PathRecord& record : early.value().path)
        EXPECT_TRUE(record.tracked()) << record.index;
    const std::vector<StampedPose> before = corrected;
    Result<ScanContent> scan = ReadScan(path, {.map = false, .frames = true});
    ASSERT_TRUE(scan.ok()) << scan.message();
    EXPECT_GT(scan.value().keyframes.size(), 3u);
    EXPECT_EQ(scan.value().loops.edges.size() >= scan.value().keyframes.size() - 1, true);
    EXPECT_EQ(scan.value().path.size(), 60u);
    EXPECT_EQ(scan.value().frames.size(), scan.value().loops.next_ordinal);
    float weight = 0;  // every frame is there, alone or in an average
    for (const FrameRecord& frame : scan.value().frames) weight += frame.stored.view.weight;
    EXPECT_TRUE(GetParam() ? weight <= 60 : weight == 60) << weight;
    EXPECT_GT(scan.value().frames.size(), 20u);
    const std::vector<StampedPose> stored = scan.value().Path();
    ASSERT_EQ(stored.size(), before.size());
    for (std::size_t i = 0; i < stored.size(); ++i)
        EXPECT_EQ(stored[i].T_world_camera.matrix(), before[i].T_world_camera.matrix()) << i;
    // Ten seconds later the camera sees the beginning of the walk, not its end. In live mode it
    // stays near the first keyframe until it is relocalised, because a slow machine may not have
    // stored the images of later frames.
    const std::vector<Frame> again =
        GetParam() ? std::vector<Frame>(300, RoomWalk(2, 1, 1).front()) : RoomWalk(21, 10, 1);
    stop_when_tracked = GetParam();
    const std::vector<FrameReport> reports = Run(again, 12, Use::kResume);
    if (!GetParam()) {
        ASSERT_EQ(reports.size(), again.size());
        EXPECT_TRUE(reports[0].tracked()) << reports[0].track.reason;
        EXPECT_EQ(corrected.size(), before.size() + reports.size());
    }
    EXPECT_TRUE(reports.back().tracked()) << reports.back().track.reason;
    std::size_t tracked = 0;
    for (std::size_t i = 0; i < reports.size(); ++i) {
        if (!reports[i].tracked()) continue;
        ++tracked;
        const Eigen::Isometry3d off =
            again[i].T_world_camera->inverse() * reports[i].track.T_world_camera;
        EXPECT_LT(off.translation().norm(), 0.02) << i;
    }
    EXPECT_EQ(corrected.size(), before.size() + tracked);  // the path covers the whole scan
}

TEST_P(ScanLoops, WhereNothingWasSeenTheCameraStaysLostAndTheMapAsItWas) {
    Run(RoomWalk(0, 20, 2), 0, Use::kBegin);
    const Result<ScanContent> before = ReadScan(path, {});
    const std::vector<FrameReport> reports = Run(RoomWalk(360, 5, 2), 12, Use::kResume);
    for (const FrameReport& report : reports) EXPECT_FALSE(report.tracked());
    const Result<ScanContent> after = ReadScan(path, {});
    ASSERT_TRUE(before.ok() && after.ok());
    ASSERT_EQ(after.value().map->size(), before.value().map->size());
    for (BlockId id = 1; id < after.value().map->size(); ++id)
        ASSERT_EQ(std::memcmp(after.value().map->field(id), before.value().map->field(id),
                              kBlockVoxels * sizeof(FieldWord)),
                  0);
}

TEST_P(ScanLoops, LocalisedOnlyTheCameraIsTrackedAndTheScanStaysByteForByte) {
    const std::vector<Frame> walk = RoomWalk(0, 60, 3);
    Run(walk, 0, Use::kBegin);
    const std::string before = FileBytes(path);
    const BlockId blocks = ReadScan(path, {}).value().map->size();
    // Its clock is earlier, it begins in the middle, and it turns far enough to confirm the place.
    const std::vector<Frame> again = RoomWalk(31, 45, 3);
    const std::vector<FrameReport> reports = Run(again, -50, Use::kLocalise);
    ASSERT_EQ(reports.size(), again.size());
    int tracked = 0;
    for (std::size_t i = 0; i < reports.size(); ++i) {
        EXPECT_FALSE(reports[i].fused);
        if (!reports[i].tracked()) continue;
        ++tracked;
        const Eigen::Isometry3d off =
            again[i].T_world_camera->inverse() * reports[i].track.T_world_camera;
        EXPECT_LT(off.translation().norm(), 0.02) << i;
    }
    EXPECT_GE(tracked, GetParam() ? 5 : 30);  // live, the answer takes a moment
    EXPECT_EQ(map_blocks, blocks - 1);
    EXPECT_TRUE(corrected.empty());
    EXPECT_EQ(FileBytes(path), before);
}

INSTANTIATE_TEST_SUITE_P(LockstepAndLive, ScanLoops, testing::Bool());

}  // namespace
}  // namespace tessera
