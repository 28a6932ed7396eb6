// Whole runs with the ICP trackers on the serial device.
#include <gtest/gtest.h>

#include <algorithm>

#include "cuda/desk_frames.h"
#include "cuda/device_pipeline.h"
#include "cuda/portable_device.h"
#include "mapping/ray_caster.h"
#include "system/pipeline.h"
#include "system/run.h"

namespace tessera::serial {
namespace {

using testing_support::DeskCamera;
using testing_support::DeskFrame;
using testing_support::DeskFrames;
using testing_support::PortableDevice;

constexpr std::size_t kPlenty = std::size_t{1} << 30;

struct ByMethod : testing::TestWithParam<TrackingMethod> {
    bool colour() const { return GetParam() == TrackingMethod::kIcpRgb; }
    PipelineConfig Config() const {
        PipelineConfig config;
        config.trackers.method = GetParam();
        return config;
    }
};

INSTANTIATE_TEST_SUITE_P(DeviceIcp, ByMethod,
                         testing::Values(TrackingMethod::kIcp, TrackingMethod::kIcpRgb),
                         [](const auto& test) {
                             return test.param == TrackingMethod::kIcp ? "Icp" : "IcpRgb";
                         });

struct DeskRun {
    std::vector<FrameReport> reports;
    std::unique_ptr<BlockMap> blocks;  // their field as the processor has it without asking for it
};

DeskRun RunDesk(const PipelineConfig& config, Device* device) {
    DeskRun run;
    Pipeline pipeline(config, DeskCamera(), {}, device);
    for (const DeskFrame& frame : DeskFrames())
        run.reports.push_back(pipeline.Process(frame.frame));
    run.blocks = CopyField(pipeline.mapping().blocks());
    return run;
}

void ExpectSamePath(const DeskRun& run, const DeskRun& expected, std::size_t frames, double move_m,
                    double turn_rad) {
    for (std::size_t i = 0; i < frames; ++i) {
        ASSERT_TRUE(run.reports[i].fused) << i << ": " << run.reports[i].track.reason;
        const Eigen::Isometry3d difference = expected.reports[i].track.T_world_camera.inverse() *
                                             run.reports[i].track.T_world_camera;
        EXPECT_LT(difference.translation().norm(), move_m) << i;
        EXPECT_LT(Se3Log(difference).head<3>().norm(), turn_rad) << i;
    }
}

bool HasVoxels(const BlockMap& map) {
    const FieldWord* begin = map.field(0);
    return std::any_of(begin, begin + static_cast<std::size_t>(map.size()) * kBlockVoxels,
                       [](FieldWord word) { return word != kUnknownField; });
}

// Only the order of summation differs, until a step of icp-rgb is accepted in one run and not in
// the other: then the two go on from poses of nearly the same energy. (The processor's vectors,
// which round otherwise, are 4 mm from its portable path here, and 0.2 mm with icp.)
TEST_P(ByMethod, TracksAndFusesAsThePortablePathDoesAndBringsNoVoxel) {
    PortableDevice portable;
    const DeskRun expected = RunDesk(Config(), &portable);
    DevicePipeline device("serial", kPlenty);
    const DeskRun run = RunDesk(Config(), &device);
    ExpectSamePath(run, expected, 7, 2e-5, 2e-5);
    ExpectSamePath(run, expected, 20, colour() ? 1.5e-3 : 1e-4, colour() ? 2e-3 : 1e-4);
    EXPECT_NEAR(run.blocks->size(), expected.blocks->size(), 0.01 * expected.blocks->size());
    EXPECT_TRUE(HasVoxels(*expected.blocks));
    EXPECT_FALSE(HasVoxels(*run.blocks));
}

TEST_P(ByMethod, TwoRunsGiveTheSamePath) {
    DevicePipeline first("serial", kPlenty), second("serial", kPlenty);
    const DeskRun a = RunDesk(Config(), &first), b = RunDesk(Config(), &second);
    for (std::size_t i = 0; i < a.reports.size(); ++i) {
        const Eigen::Isometry3d& T_world_camera = a.reports[i].track.T_world_camera;
        EXPECT_EQ(T_world_camera.matrix(), b.reports[i].track.T_world_camera.matrix()) << i;
    }
}

// Without OpenGL the processor's ray caster steps in: predicted there in any case.
TEST_P(ByMethod, TracksAgainstAViewThatTheProcessorPredicted) {
    PipelineConfig config = Config();
    config.trackers.icp.prediction = IcpTracker::Prediction::kRaster;
    PortableDevice portable;
    DevicePipeline device("serial", kPlenty);
    const DeskRun run = RunDesk(config, &device);
    ExpectSamePath(run, RunDesk(config, &portable), 20, colour() ? 1.5e-3 : 1e-4,
                   colour() ? 2e-3 : 1e-4);
    EXPECT_TRUE(HasVoxels(*run.blocks));
}

// The frame of the switch is the first that reads the processor's voxels.
TEST_P(ByMethod, ASwitchToAViewOfTheProcessorBringsTheVoxelsFirst) {
    DevicePipeline device("serial", kPlenty);
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

// The window's picture, while the voxels are on the device only.
TEST(DevicePipeline, TheWindowsViewBringsNoVoxel) {
    PipelineConfig config;
    DevicePipeline device("serial", kPlenty);
    Pipeline pipeline(config, DeskCamera(), {}, &device);
    for (std::size_t i = 0; i < 3; ++i) pipeline.Process(DeskFrames()[i].frame);
    PredictedView view, expected;
    pipeline.mapping().Predict(DeskFrames()[2].T_world_camera, 4, view);
    EXPECT_FALSE(HasVoxels(pipeline.mapping().blocks()));
    const float far_m = 1.2f * static_cast<float>(config.frame.max_depth_m);
    RayCaster(VectorPath::kBaseline)
        .Predict(pipeline.map(), DeskCamera().Every(4), DeskFrames()[2].T_world_camera, 0.1f, far_m,
                 expected);
    testing_support::ExpectSameView(view, expected);
}

}  // namespace
}  // namespace tessera::serial
