#include "system/live_engine.h"

#include <algorithm>
#include <filesystem>
#include <future>

#include "render/mesh_rasteriser.h"
#include "support/temp_folder.h"
#include "system/engine_fixture.h"

namespace tessera {
namespace {

class Live : public EngineTest {};

// The source returns its next frame when the previous one is done, so no frame has to be dropped.
TEST_F(Live, EveryFrameIsAccountedForAndTrackedToTheMillimetre) {
    config.live.queue_frames = 30;
    Make(true, {.count = 30});
    TakeAll();
    EXPECT_TRUE(engine->status().ok());
    EXPECT_FALSE(engine->stopped());
    EXPECT_EQ(Count(Kind::kFrame) + Count(Kind::kDropped), 30);
    const auto reports = Reports();
    ASSERT_GT(reports.size(), 15u);
    EXPECT_TRUE(reports.front()->first);
    for (std::size_t i = 0; i < reports.size(); ++i) {
        EXPECT_TRUE(reports[i]->tracked()) << reports[i]->track.reason;
        EXPECT_LT(Error_m(*reports[i]), 0.004) << "frame " << reports[i]->index;
        EXPECT_GT(reports[i]->index, i > 0 ? reports[i - 1]->index : -1);
    }
    EXPECT_GT(engine->map_statistics().blocks, 100);
    EXPECT_GT(engine->TakeMesh().triangles.size(), 1000u);
}

// Tracking has its own copy of the map's colours.
TEST_F(Live, ChromaIsTrackedInTheCopyOfTheMap) {
    config.pipeline.trackers.sdf.chroma = true;
    Make(true, {.count = 12});
    TakeAll();
    const auto reports = Reports();
    ASSERT_FALSE(reports.empty());
    for (const FrameReport* report : reports) {
        EXPECT_TRUE(report->tracked()) << report->track.reason;
        if (!report->first) {
            EXPECT_GT(report->track.alpha, 0);
        }
    }
}

// Slower than tracking, even on a busy machine and under ThreadSanitizer.
#ifdef __SANITIZE_THREAD__
constexpr double kSlowMapping_ms = 1000;
#else
constexpr double kSlowMapping_ms = 300;
#endif

// If mapping is far slower than tracking, all frames are tracked but not all are fused. The number
// of fused frames depends on the machine.
TEST_F(Live, SlowMappingLeavesFramesUnfusedAndTracksThem) {
    config.live.playback_speed = 1;
    config.live.extra_mapping_ms = kSlowMapping_ms;
    config.live.queue_frames = 45;  // no frame is dropped before tracking
    config.loops.enabled = false;   // their queue holds thousands of poses
    Make(true, {.count = 45, .speed = 0.3});
    TakeAll();
    std::int64_t unfused = 0, fused = 0;
    for (const FrameOutcome& o : outcomes) {
        if (o.kind != Kind::kFrame) continue;
        unfused += o.fusion_dropped;
        fused += o.report.fused;
        EXPECT_TRUE(o.report.tracked()) << o.report.track.reason;
        EXPECT_LT(Error_m(o.report, 0.3), 0.01) << "frame " << o.report.index;
        for (const auto& [name, waiting] : o.queues)
            EXPECT_LE(waiting, std::string_view(name) == "to tracking" ? 45u : 8u) << name;
    }
    EXPECT_EQ(Count(Kind::kFrame), 45);
    EXPECT_GT(unfused, 10);
    EXPECT_GT(fused, 1);
    EXPECT_EQ(fused + unfused, 45);
}

// If tracking is ten times too slow, old frames are dropped and the newest are tracked. The slow
// camera is not lost.
TEST_F(Live, SlowTrackingDropsOldFramesAndKeepsThePose) {
    config.live.playback_speed = 1;
    config.live.extra_tracking_ms = 330;
    config.pipeline.motion.max_gap_s = 1;
    Make(true, {.count = 60, .speed = 0.3});
    TakeAll();
    EXPECT_EQ(Count(Kind::kFrame) + Count(Kind::kDropped), 60);
    EXPECT_GT(Count(Kind::kDropped), 40);
    ASSERT_GE(Reports().size(), 5u);
    for (const FrameReport* report : Reports()) {
        EXPECT_TRUE(report->tracked()) << report->track.reason;
        EXPECT_LT(Error_m(*report, 0.3), 0.01) << "frame " << report->index;
    }
    EXPECT_GE(Reports().back()->index, 57);  // the newest frame, not the oldest waiting one
}

TEST_F(Live, BadFramesWaitsAndABrokenSourceAreTold) {
    Make(true, {.before_read = [waited = false](std::int64_t i) mutable -> ReadResult {
             if (i == 2) return {ReadStatus::kSkip, "torn"};
             if (i == 4 && !std::exchange(waited, true))
                 return {ReadStatus::kWait, "camera unplugged"};
             if (i == 6) return {ReadStatus::kError, "burnt"};
             return {};
         }});
    TakeAll();
    EXPECT_EQ(Count(Kind::kSkipped), 1);
    EXPECT_EQ(Count(Kind::kMessage), 1);
    EXPECT_EQ(Count(Kind::kFrame) + Count(Kind::kDropped), 5);
    EXPECT_EQ(engine->status().message(), "burnt");
    EXPECT_NE(Messages().find("torn\n"), std::string::npos);
}

// Next must not take a message that is just being told for the end of the run.
TEST_F(Live, ManyMessagesEndNothing) {
    config.live.queue_frames = 1000;
    Make(true, {.count = 60, .before_read = [told = 0](std::int64_t) mutable -> ReadResult {
                    if (++told % 500 != 0) return {ReadStatus::kWait, "camera unplugged"};
                    return {};
                }});
    TakeAll();
    EXPECT_EQ(Count(Kind::kFrame), 60);
    EXPECT_GT(Count(Kind::kMessage), 60);
    EXPECT_TRUE(engine->status().ok());
    EXPECT_GT(engine->TakeMesh().triangles.size(), 0u);
}

// Acts like a full disk: the recording ends with a message, and the scan continues.
TEST_F(Live, ARecordingThatFailsEndsAloneAndIsTold) {
    TempFolder folder;
    EngineInput input = Input({.count = 20, .before_read = [&](std::int64_t i) -> ReadResult {
                                   if (i == 5)
                                       std::filesystem::rename(folder / "raw", folder / "gone");
                                   return {};
                               }});
    input.config.live.queue_frames = 30;
    input.record_path = folder / "raw";
    engine = std::make_unique<LiveEngine>(std::move(input));
    TakeAll();
    EXPECT_EQ(Reports().size() + static_cast<std::size_t>(Count(Kind::kDropped)), 20u);
    EXPECT_NE(Messages().find("recording ended: " + (folder / "raw")), std::string::npos)
        << Messages();
}

TEST_F(Live, AStopEndsItSoonAndKeepsTheMap) {
    Make(true, {});
    while (Reports().size() < 3) ASSERT_TRUE(Next());
    stop = true;
    TakeAll();
    EXPECT_LE(Reports().size(), 25u);  // frames already queued are still processed
    EXPECT_TRUE(engine->stopped());
    EXPECT_GT(engine->map_statistics().blocks, 100);
}

TEST_F(Live, ItCanBeLetGoAtAnyMoment) {
    Make(true, {});
    ASSERT_TRUE(Next());
    engine.reset();
}

TEST_F(Live, ViewerCommandsAreObeyed) {
    ViewerLink link;
    viewer = &link;
    TempFolder folder;
    Make(true, {.live = true});
    while (Reports().size() < 4) ASSERT_TRUE(Next());
    ViewerSettings settings;
    settings.method = TrackingMethod::kIcp;
    settings.method_choices = 1;
    link.settings.Push(ViewerSettings(settings));
    // Single frames may be lost after many dropped frames.
    while (Reports().back()->method != TrackingMethod::kIcp || !Reports().back()->tracked())
        ASSERT_TRUE(Next());
    Ask(Command::kSaveMesh, folder / "now.ply");
    while (Messages().find("saved ") == std::string::npos) ASSERT_TRUE(Next());
    EXPECT_TRUE(std::filesystem::exists(folder / "now.ply"));
    Ask(Command::kReset);
    while (Count(Kind::kReset) == 0) ASSERT_TRUE(Next());
    const std::size_t before = Reports().size();
    while (Reports().size() < before + 3 || !Reports().back()->tracked()) ASSERT_TRUE(Next());
    EXPECT_TRUE(Reports()[before]->first);
    EXPECT_LT(Reports()[before]->track.T_world_camera.translation().norm(), 1e-12);  // new world
    Ask(Command::kStop);
    TakeAll();
    EXPECT_TRUE(engine->stopped());
}

// The user switches ICP's predicted view, here and in lockstep.
TEST_F(Live, ThePredictedViewIsSwitchedAsInLockstep) {
    if (const auto made = MeshRasteriser::Create({}); !made.ok()) GTEST_SKIP() << made.message();
    ViewerLink link;
    viewer = &link;
    config.pipeline.trackers.method = TrackingMethod::kIcp;
    for (const bool live : {false, true}) {
        outcomes.clear();
        Make(live, {.live = true});
        while (Reports().size() < 3) ASSERT_TRUE(Next());
        EXPECT_EQ(Reports().back()->rasterise_ms, 0);
        ViewerSettings settings;
        settings.method = TrackingMethod::kIcp;
        for (const auto prediction :
             {IcpTracker::Prediction::kRaster, IcpTracker::Prediction::kRayCast}) {
            settings.prediction = prediction;
            link.settings.Push(ViewerSettings(settings));
            const bool raster = prediction == IcpTracker::Prediction::kRaster;
            while ((Reports().back()->rasterise_ms > 0) != raster) {
                ASSERT_TRUE(Next());
                ASSERT_LT(Reports().size(), 200u) << "the views stay as they are";
            }
            EXPECT_TRUE(live || Reports().back()->tracked());
        }
        Ask(Command::kStop);
        TakeAll();
    }
}

// Sends random commands while a simulated window reads its queues only occasionally. Meant for the
// sanitizers.
TEST_F(Live, RandomCommandsDoNoHarm) {
    ViewerLink link;
    viewer = &link;
    TempFolder folder;
    config.live.playback_speed = 1;
    config.pipeline.trackers.icp.prediction = IcpTracker::Prediction::kRayCast;
    const char* seconds = std::getenv("TESSERA_SOAK_S");
    const std::int64_t frames = 30 * (seconds != nullptr ? std::atoi(seconds) : 3);
    Make(true, {.count = frames});
    AskAtRandomToTheEnd(folder);
    EXPECT_TRUE(engine->status().ok());
    engine->TakeMesh();
}

}  // namespace
}  // namespace tessera
