// Runs in the box room that are saved, and what the files hold.
#include "system/scan_stage.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "run/open_source.h"
#include "run/scan_export.h"
#include "support/box_room_source.h"
#include "system/scan_fixture.h"

namespace tessera {
namespace {

using testing_support::BoxRoomSource;

TEST_F(Scan, SavingChangesNothingAndTheFileHoldsTheSameMesh) {
    const TriangleMesh alone = Run(false, {}, {.count = 24});
    config.scan.interval_s = 0.1;
    ExpectSame(Run(false, New(), {.count = 24}), alone);
    ScanContent scan = Content();
    EXPECT_TRUE(scan.finished);
    EXPECT_EQ(scan.path.size(), 24u);
    EXPECT_EQ(scan.progress.last_index, 23);
    const Result<TriangleMesh> mesh = MeshOfScan(scan);
    ASSERT_TRUE(mesh.ok()) << mesh.message();
    ExpectSame(mesh.value(), alone);
}

// A save requested after some frames gives the same file as saving from the first frame on.
TEST_F(Scan, SavedFromTheMiddleOnItIsTheWholeScan) {
    Run(false, New(), {.count = 24});
    ScanContent whole = Content();
    path = folder / "b.scan";
    ViewerLink link;
    viewer = &link;
    outcomes.clear();
    Make(false, {.count = 24});
    while (Reports().size() < 9) ASSERT_TRUE(Next());
    Ask(Command::kSaveScan, path);
    Ask(Command::kSaveScan, folder / "c.scan");
    TakeAll();
    EXPECT_NE(Messages().find("scan saved"), std::string::npos) << Messages();
    EXPECT_NE(Messages().find("is already being saved"), std::string::npos) << Messages();
    EXPECT_FALSE(std::filesystem::exists(folder / "c.scan"));
    ScanContent middle = Content();
    ExpectSame(MeshOfScan(middle).value(), MeshOfScan(whole).value());
    ASSERT_EQ(middle.path.size(), 24u);
    for (std::size_t i = 0; i < 24; ++i)
        EXPECT_EQ(middle.path[i].Encode(), whole.path[i].Encode()) << i;
    EXPECT_EQ(middle.tracking, whole.tracking);
    EXPECT_EQ(middle.progress.Encode(), whole.progress.Encode());
}

TEST_F(Scan, LiveItIsSavedWhenAPersonAsksForIt) {
    ViewerLink link;
    viewer = &link;
    config.live.queue_frames = 30;
    EngineInput input = Input({.live = true});
    engine = std::make_unique<LiveEngine>(std::move(input));
    while (Reports().size() < 6) ASSERT_TRUE(Next());
    Ask(Command::kSaveScan, path);
    while (Messages().find("scan saved") == std::string::npos) ASSERT_TRUE(Next());
    const std::size_t before = Reports().size();
    while (Reports().size() < before + 6) ASSERT_TRUE(Next());
    Ask(Command::kStop);
    TakeAll();
    const TriangleMesh mesh = engine->TakeMesh();
    ScanContent scan = Content();
    EXPECT_EQ(scan.path.size(), Reports().size());
    EXPECT_FALSE(scan.tracking.empty());
    ExpectSame(MeshOfScan(scan).value(), mesh);
}

TEST_F(Scan, AllFramesCanBeKeptAndReplayed) {
    config.scan.frames = ScanConfig::Frames::kAll;
    Run(false, New(), {.count = 8});
    const auto replay = OpenSource(path, config);
    ASSERT_TRUE(replay.ok()) << replay.message();
    BoxRoomSource original({.count = 8});
    EXPECT_EQ(replay.value()->info().frame_count, 8);
    Frame expected, actual;
    for (int i = 0; i < 8; ++i) {
        original.Read(expected);
        ASSERT_EQ(replay.value()->Read(actual).status, ReadStatus::kOk);
        EXPECT_EQ(actual.stamp_s, expected.stamp_s);
        EXPECT_TRUE(actual.T_world_camera->isApprox(*expected.T_world_camera));
        for (std::size_t k = 0; k < actual.depth_m.size(); ++k)
            ASSERT_NEAR(actual.depth_m.data()[k], expected.depth_m.data()[k], 0.5 / 5000 + 1e-6);
    }
    EXPECT_EQ(replay.value()->Read(actual).status, ReadStatus::kEnd);
}

TEST_F(Scan, WithoutFramesThereIsNothingToReplay) {
    config.loops.enabled = false;  // loop closure keeps frames
    Run(false, New(), {.count = 4});
    const auto replay = OpenSource(path, config);
    ASSERT_FALSE(replay.ok());
    EXPECT_NE(replay.message().find("scan.frames=all"), std::string::npos) << replay.message();
}

TEST_F(Scan, AResetBeginsTheFileAnew) {
    ViewerLink link;
    viewer = &link;
    EngineInput input = Input({.count = 12});
    input.scan = New();
    engine = std::make_unique<LockstepEngine>(std::move(input));
    for (int i = 0; i < 7; ++i) ASSERT_TRUE(Next());
    Ask(Command::kReset);
    TakeAll();
    EXPECT_EQ(Content().path.size(), 5u);
    EXPECT_EQ(Content().progress.frames, 5);
}

}  // namespace
}  // namespace tessera
