// When a scan's checkpoints are written, and what is in them.
#include <gtest/gtest.h>

#include "mapping/analytic_fields.h"
#include "support/temp_folder.h"
#include "system/loop_journal.h"
#include "system/scan_stage.h"

namespace tessera {
namespace {

// A map, and a scan file for it. Frames come a second apart.
struct Saved {
    Saved(ScanConfig config, bool wait) {
        run.pipeline.map = {.voxel_size_m = 0.01, .truncation_m = 0.04};
        run.loops.enabled = false;
        mapping.emplace(run.pipeline, MeshConfig{0, 0}, source.camera);
        Result<ScanPlan> plan = BeginScan(path, source, run);
        EXPECT_TRUE(plan.ok()) << plan.message();
        scan.emplace(std::move(plan.value()), config, wait, false, notices);
    }
    void Add(int i) {
        Frame frame;
        frame.index = i;
        frame.stamp_s = frame.colour_stamp_s = i;
        frame.depth_m = DepthImage(8, 6, 1);
        TrackedFrame tracked;
        tracked.report.track.status = TrackStatus::kGood;
        scan->AddFrame(frame, tracked, 0);
        scan->SaveIfDue(*mapping);
        EXPECT_TRUE(scan->Settle(*mapping, false));
    }
    ScanContent Content() const {
        Result<ScanContent> content = ReadScan(path, {.map = true, .frames = true});
        EXPECT_TRUE(content.ok()) << content.message();
        return std::move(content.value());
    }

    TempFolder folder;
    const std::string path = folder / "a.scan";
    RunConfig run;
    SourceInfo source;
    Wake reader;
    Notices notices{reader};
    std::optional<MappingStage> mapping;
    std::optional<ScanStage> scan;
};

// A run that is killed just after a map was corrected keeps its latest surfaces.
TEST(ScanCheckpoints, NoneLacksWhatIsStillToFollowACorrectedMap) {
    Saved saved({}, false);
    auto wall = std::make_unique<BlockMap>(saved.run.pipeline.map);
    testing_support::Fill(*wall, testing_support::Plane({0, 0, -1}, -1.003), {-25, -25, 12},
                          {25, 25, 12});
    const BlockId blocks = wall->size();
    saved.mapping->Resume(std::move(wall), 1);
    saved.Add(0);
    ASSERT_EQ(saved.Content().map->size(), blocks);
    saved.mapping->ReplaceMoved(std::make_unique<BlockMap>(saved.run.pipeline.map),
                                Eigen::Isometry3d::Identity(), 0);
    ASSERT_TRUE(saved.mapping->following());  // there is more than follows at once
    saved.Add(1);
    EXPECT_EQ(saved.Content().map->size(), blocks);
    while (saved.mapping->following()) saved.mapping->Follow();
    saved.Add(2);
    EXPECT_GE(saved.Content().map->size(), blocks);
    EXPECT_EQ(saved.Content().path.size(), 3u);
}

// However long the interval, so that they do not fill the memory, and live none is dropped.
TEST(ScanCheckpoints, RawFramesDoNotWaitForTheInterval) {
    for (const bool wait : {false, true}) {
        Saved saved({.interval_s = 60, .frames = ScanConfig::Frames::kAll}, wait);
        for (int i = 0; i < 20; ++i) saved.Add(i);
        const ScanContent content = saved.Content();
        EXPECT_GE(content.frames.size(), 15u) << wait;
        EXPECT_EQ(content.frames.size(), content.path.size()) << wait;
    }
}

// The frames may be newer than what the file says of the next one.
TEST(ScanCheckpoints, AResumedScanUsesNoOrdinalTwice) {
    ScanContent scan;
    scan.loops.next_ordinal = 3;
    EXPECT_EQ(TakeLoopMemory(scan).next_ordinal, 3);
    for (const std::int64_t ordinal : {2, 3, 4}) {
        FrameRecord& frame = scan.frames.emplace_back();
        frame.in_store = true;
        frame.stored.ordinal = ordinal;
    }
    EXPECT_EQ(TakeLoopMemory(scan).next_ordinal, 5);
}

}  // namespace
}  // namespace tessera
