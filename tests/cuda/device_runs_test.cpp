// Complete runs on the host device. They equal the CPU runs bit for bit.
#include <gtest/gtest.h>

#include "cuda/desk_run.h"
#include "cuda/device_pipeline.h"
#include "mapping/ray_caster.h"
#include "run/run.h"
#include "synth/synthetic_source.h"

namespace tessera::host {
namespace {

using testing_support::DeskCamera;
using testing_support::DeskFrames;
using testing_support::DeskRun;
using testing_support::ExpectSameRun;
using testing_support::kPlenty;

struct ByMethod : testing::TestWithParam<TrackingMethod> {
    PipelineConfig Config() const {
        PipelineConfig config;
        config.trackers.method = GetParam();
        return config;
    }
};

std::string NameOf(const testing::TestParamInfo<TrackingMethod>& test) {
    switch (test.param) {
        case TrackingMethod::kSdf: return "Sdf";
        case TrackingMethod::kSdfGeometric: return "SdfGeometric";
        case TrackingMethod::kIcp: return "Icp";
        case TrackingMethod::kIcpRgb: break;
    }
    return "IcpRgb";
}

INSTANTIATE_TEST_SUITE_P(DeviceRuns, ByMethod,
                         testing::Values(TrackingMethod::kSdf, TrackingMethod::kSdfGeometric,
                                         TrackingMethod::kIcp, TrackingMethod::kIcpRgb),
                         NameOf);

TEST_P(ByMethod, IsTheProcessorsAndBringsNoVoxel) {
    DeskRun expected(Config(), nullptr);
    DevicePipeline device("host", kPlenty);
    DeskRun run(Config(), &device);
    EXPECT_TRUE(expected.HasVoxels());
    EXPECT_FALSE(run.HasVoxels());
    ExpectSameRun(run, expected);
}

struct ByIcp : ByMethod {};

INSTANTIATE_TEST_SUITE_P(DeviceRuns, ByIcp,
                         testing::Values(TrackingMethod::kIcp, TrackingMethod::kIcpRgb), NameOf);

// Without OpenGL the CPU's ray caster is used instead. In both cases the CPU predicts the view.
TEST_P(ByIcp, IsTheProcessorsOnViewsThatTheProcessorDrew) {
    PipelineConfig config = Config();
    config.trackers.icp.prediction = IcpTracker::Prediction::kRaster;
    DeskRun expected(config, nullptr);
    DevicePipeline device("host", kPlenty);
    DeskRun run(config, &device);
    EXPECT_TRUE(run.HasVoxels());
    ExpectSameRun(run, expected);
}

// The first frame after the switch is the first to read the voxels on the host.
TEST_P(ByIcp, ASwitchToAViewOfTheProcessorBringsTheVoxelsFirst) {
    DevicePipeline device("host", kPlenty);
    RunRequest request;
    request.source = "synthetic:desk";
    request.selection.count = 5;
    request.switches = {{3, GetParam()}};
    request.device = &device;
    RunConfig config;
    config.synthetic.camera = DeskCamera();
    config.pipeline.trackers.icp.prediction = IcpTracker::Prediction::kRaster;
    const std::atomic<bool> stop{false};
    const auto run = ExecuteRun(request, config, {}, stop);
    ASSERT_TRUE(run.ok()) << run.message();
    EXPECT_EQ(run.value().counts.frames, 5);
    EXPECT_EQ(run.value().counts.tracked, 5) << run.value().last_reason;
}

// The settings of [B14], whose weights decay exponentially, and which aligns three colour channels.
TEST(DeviceRuns, IsTheProcessorsWithOtherWeightsAndChroma) {
    PipelineConfig config;
    config.fusion.distance_weight = DistanceWeight::kLinearExp;
    config.fusion.colour_weighting = ColourWeighting::kCosine;
    config.trackers.sdf.chroma = true;
    DeskRun expected(config, nullptr);
    DevicePipeline device("host", kPlenty);
    DeskRun run(config, &device);
    ExpectSameRun(run, expected);
}

TEST(DeviceRuns, SaysInOneLineThatItsMemoryIsFullAndGoesOn) {
    DevicePipeline device("host", std::size_t{16} << 20);
    DeskRun run({}, &device);
    std::string warning;
    for (const FrameReport& report : run.reports)
        if (!report.warning.empty()) warning = report.warning;
    EXPECT_NE(warning.find("16 MB"), std::string::npos) << warning;
    EXPECT_NE(warning.find("mapping.device_memory_mb"), std::string::npos) << warning;
    EXPECT_GT(run.pipeline.map().size(), 500);
    EXPECT_TRUE(run.reports.back().tracked());
}

// Frames are prepared a second time without their moving regions.
TEST(DeviceRuns, IsTheProcessorsWherePeopleWalk) {
    SynthConfig synthetic;
    synthetic.camera = {160, 120, 131, 131, 79.5, 59.5};
    synthetic.fps = 15;
    synthetic.frames = 45;
    auto source = OpenSynthetic("people", synthetic);
    ASSERT_TRUE(source.ok());
    PipelineConfig config;
    config.moving.enabled = true;
    config.map.voxel_size_m = 0.02;
    config.map.truncation_m = 0.08;
    DevicePipeline device("host", kPlenty);
    Pipeline expected(config, synthetic.camera), run(config, synthetic.camera, {}, &device);
    std::int64_t moving = 0;
    for (Frame frame; source.value()->Read(frame).status == ReadStatus::kOk;) {
        const FrameReport wanted = expected.Process(frame), report = run.Process(frame);
        testing_support::ExpectSameTrack(report.track, wanted.track,
                                         static_cast<std::size_t>(frame.index));
        ASSERT_EQ(report.moving == nullptr, wanted.moving == nullptr) << frame.index;
        if (!report.moving) continue;
        EXPECT_EQ(report.moving->moving, wanted.moving->moving) << frame.index;
        EXPECT_EQ(report.moving->gone_m, wanted.moving->gone_m) << frame.index;
        moving += report.moving->moving_tiles;
    }
    EXPECT_GT(moving, 1000);
    testing_support::ExpectSameMap(run.map(), expected.map());
}

// Predicts the view for the window while the voxels are only on the device.
TEST(DeviceRuns, TheWindowsViewBringsNoVoxel) {
    PipelineConfig config;
    DevicePipeline device("host", kPlenty);
    DeskRun run(config, &device);
    PredictedView view, expected;
    run.pipeline.mapping().Predict(DeskFrames()[2].T_world_camera, 4, view);
    EXPECT_FALSE(run.HasVoxels());
    const float far_m = 1.2f * static_cast<float>(config.frame.max_depth_m);
    RayCaster().Predict(run.pipeline.map(), DeskCamera().Every(4), DeskFrames()[2].T_world_camera,
                        0.1f, far_m, expected);
    testing_support::ExpectSameView(view, expected);
}

}  // namespace
}  // namespace tessera::host
