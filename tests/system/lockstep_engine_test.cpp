#include "system/lockstep_engine.h"

#include <chrono>
#include <cstring>
#include <future>

#include "run/open_source.h"
#include "support/temp_folder.h"
#include "system/engine_fixture.h"

namespace tessera {
namespace {

class Lockstep : public EngineTest {};

// A viewer does not change any result.
TEST_F(Lockstep, TheSameBytesWithAndWithoutAViewer) {
    Make(false, {.count = 12});
    TakeAll();
    const TriangleMesh mesh = engine->TakeMesh();
    const std::vector<FrameOutcome> alone = std::move(outcomes);
    outcomes.clear();
    ViewerLink link;
    viewer = &link;
    config.live.mesh_blocks = 40;
    Make(false, {.count = 12});
    TakeAll();
    ASSERT_EQ(outcomes.size(), alone.size());
    for (std::size_t i = 0; i < alone.size(); ++i)
        EXPECT_EQ(outcomes[i].report.track.T_world_camera.matrix(),
                  alone[i].report.track.T_world_camera.matrix());
    const TriangleMesh seen = engine->TakeMesh();
    EXPECT_EQ(seen.vertices, mesh.vertices);
    EXPECT_EQ(seen.triangles, mesh.triangles);
    EXPECT_EQ(seen.colours, mesh.colours);
    MeshUpdate update;
    ASSERT_TRUE(link.meshes.TryPop(update));
    EXPECT_FALSE(update.blocks.empty());
    ImageUpdate images;
    ASSERT_TRUE(link.images.TryPop(images));
    ASSERT_TRUE(images.frame && images.predicted);
    EXPECT_EQ(images.predicted->depth_m.width(), images.frame->depth_m.width() / 4);
}

TEST_F(Lockstep, PauseStepResumeLetExactlySoManyFramesPass) {
    ViewerLink link;
    viewer = &link;
    Ask(Command::kPause);
    Ask(Command::kStep);
    Ask(Command::kStep);
    Ask(Command::kSaveMesh, "unwritable/nowhere.ply");  // executed while paused
    Make(false, {.count = 6});
    ASSERT_TRUE(Next());
    EXPECT_EQ(outcomes.back().kind, Kind::kMessage);  // there is nothing to save yet
    ASSERT_TRUE(Next());
    ASSERT_TRUE(Next());
    EXPECT_EQ(Reports().size(), 2u);
    Ask(Command::kSaveMesh, "unwritable/nowhere.ply");
    ASSERT_TRUE(Next());  // a message, not a third frame
    EXPECT_EQ(outcomes.back().kind, Kind::kMessage);
    EXPECT_NE(outcomes.back().message.find("unwritable/nowhere.ply"), std::string::npos)
        << outcomes.back().message;
    Ask(Command::kResume);
    TakeAll();
    EXPECT_EQ(Reports().size(), 6u);
}

// A camera that has no frame for a while uses up no step.
TEST_F(Lockstep, AStepLastsUntilThereIsAFrame) {
    ViewerLink link;
    viewer = &link;
    Ask(Command::kStep);
    Make(false, {.count = 2, .before_read = [waits = 0](std::int64_t) mutable -> ReadResult {
                     if (++waits <= 3) return {ReadStatus::kWait, {}};
                     return {};
                 }});
    auto next = std::async(std::launch::async, [this] { return Next(); });
    if (next.wait_for(std::chrono::minutes(1)) != std::future_status::ready)
        stop = true;  // rather than to hang
    EXPECT_TRUE(next.get());
    EXPECT_EQ(Reports().size(), 1u);
    Ask(Command::kResume);
    TakeAll();
    EXPECT_EQ(Reports().size(), 2u);
}

TEST_F(Lockstep, AResetBeginsANewWorldAndKeepsTheMethod) {
    ViewerLink link;
    viewer = &link;
    Make(false, {.count = 8});
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(Next());
    MeshUpdate update;
    while (link.meshes.TryPop(update)) {
    }
    ViewerSettings settings;
    settings.method = TrackingMethod::kSdfGeometric;
    settings.method_choices = 1;
    link.settings.Push(std::move(settings));
    Ask(Command::kReset);
    TakeAll();
    ASSERT_EQ(Count(Kind::kReset), 1);
    const auto reports = Reports();
    ASSERT_EQ(reports.size(), 8u);
    EXPECT_TRUE(reports[4]->first);
    EXPECT_EQ(reports[5]->method, TrackingMethod::kSdfGeometric);
    EXPECT_TRUE(reports[7]->tracked());
    ASSERT_TRUE(link.meshes.TryPop(update));
    EXPECT_TRUE(update.clear);
}

TEST_F(Lockstep, WhatIsRecordedIsTheSourceAgain) {
    TempFolder folder;
    EngineInput input = Input({.count = 5});
    input.record_path = folder / "raw";
    engine = std::make_unique<LockstepEngine>(std::move(input));
    TakeAll();
    EXPECT_NE(Messages().find("recorded 5 frames"), std::string::npos) << Messages();
    const auto again = OpenSource(folder / "raw", config);
    ASSERT_TRUE(again.ok()) << again.message();
    testing_support::BoxRoomSource original({.count = 5});
    Frame expected, actual;
    for (int i = 0; i < 5; ++i) {
        ASSERT_EQ(original.Read(expected).status, ReadStatus::kOk);
        ASSERT_EQ(again.value()->Read(actual).status, ReadStatus::kOk);
        EXPECT_NEAR(actual.stamp_s, expected.stamp_s, 1e-6);
        ASSERT_EQ(actual.depth_m.size(), expected.depth_m.size());
        for (std::size_t k = 0; k < actual.depth_m.size();
             ++k)  // the source's depth is not rounded to recording units
            ASSERT_NEAR(actual.depth_m.data()[k], expected.depth_m.data()[k], 0.5 / 5000 + 1e-6);
    }
}

TEST_F(Lockstep, ARecordingThatCannotBeMadeIsAnError) {
    EngineInput input = Input({.count = 5});
    input.record_path = "/proc/nowhere";
    engine = std::make_unique<LockstepEngine>(std::move(input));
    EXPECT_FALSE(Next());
    EXPECT_NE(engine->status().message().find("/proc/nowhere"), std::string::npos)
        << engine->status().message();
}

}  // namespace
}  // namespace tessera
