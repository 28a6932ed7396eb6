// Live runs on the host device, where one thread does both tracking and mapping.
#include "cuda/desk_frames.h"
#include "cuda/device_pipeline.h"
#include "run/run.h"
#include "system/engine_fixture.h"

namespace tessera::host {
namespace {

class DeviceLive : public EngineTest {
  protected:
    DeviceLive() { config.live.queue_frames = 30; }
    void MakeOnDevice(const Source::Options& options) {
        EngineInput input = Input(options);
        input.device = &device;
        engine = std::make_unique<LiveEngine>(std::move(input));
    }

    DevicePipeline device{"host", std::size_t{1} << 30};
};

// If no frame is dropped, the result equals that of a lockstep run on the CPU, bit for bit.
TEST_F(DeviceLive, IsTheLockstepRunWhereNoFrameIsDropped) {
    Make(false, {.count = 30});
    TakeAll();
    const std::vector<FrameOutcome> expected = std::exchange(outcomes, {});
    const TriangleMesh expected_mesh = engine->TakeMesh();
    MakeOnDevice({.count = 30});
    TakeAll();
    ASSERT_EQ(outcomes.size(), expected.size());
    EXPECT_EQ(Count(Kind::kFrame), 30);
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        EXPECT_TRUE(outcomes[i].report.fused) << i;
        testing_support::ExpectSameTrack(outcomes[i].report.track, expected[i].report.track, i);
        EXPECT_EQ(outcomes[i].map.blocks, expected[i].map.blocks);
    }
    const TriangleMesh mesh = engine->TakeMesh();
    EXPECT_GT(mesh.triangles.size(), 1000u);
    EXPECT_EQ(mesh.vertices, expected_mesh.vertices);
    EXPECT_EQ(mesh.triangles, expected_mesh.triangles);
}

TEST_F(DeviceLive, SlowWorkDropsOldFramesAndKeepsThePose) {
    config.live.playback_speed = 1;
    config.live.queue_frames = 2;
    config.live.extra_tracking_ms = 330;
    config.pipeline.motion.max_gap_s = 2;
    MakeOnDevice({.count = 60, .speed = 0.3});
    TakeAll();
    EXPECT_EQ(Count(Kind::kFrame) + Count(Kind::kDropped), 60);
    EXPECT_GT(Count(Kind::kDropped), 40);
    for (const FrameReport* report : Reports()) {
        EXPECT_TRUE(report->fused) << report->track.reason;
        EXPECT_LT(Error_m(*report, 0.3), 0.01) << "frame " << report->index;
    }
}

// Sends random commands, like Live.RandomCommandsDoNoHarm. Meant for the sanitizers.
TEST_F(DeviceLive, RandomCommandsDoNoHarm) {
    ViewerLink link;
    viewer = &link;
    TempFolder folder;
    config.live.playback_speed = 1;
    config.pipeline.trackers.icp.prediction = IcpTracker::Prediction::kRayCast;
    config.loops.enabled = true;
    MakeOnDevice({.count = 90});
    AskAtRandomToTheEnd(folder);
    EXPECT_TRUE(engine->status().ok()) << engine->status().message();
    engine->TakeMesh();
}

// Another thread runs the detector. Its detections vote in the map on the device.
TEST(DeviceLiveRun, LabelsWhatItScans) {
    DevicePipeline device("host", std::size_t{1} << 30);
    const TempFolder folder;
    RunRequest request;
    request.source = "synthetic:desk";
    request.selection.count = 20;
    request.live = true;
    request.labels = "synthetic";
    request.output_folder = folder.path();
    request.device = &device;
    RunConfig config;
    config.synthetic.camera = testing_support::DeskCamera();
    config.live.queue_frames = 20;
    config.labels.max_rate_hz = 1000;
    config.labels.min_observations = 1;
    const std::atomic<bool> stop{false};
    const auto run = ExecuteRun(request, config, {}, stop);
    ASSERT_TRUE(run.ok()) << run.message();
    EXPECT_EQ(run.value().counts.tracked, 20) << run.value().last_reason;
    EXPECT_GT(run.value().labels->detections, 0);
    EXPECT_GT(run.value().labels->objects.size(), 0u);
}

}  // namespace
}  // namespace tessera::host
