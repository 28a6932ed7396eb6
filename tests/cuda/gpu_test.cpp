// Tests that need a GPU. Without a GPU or without the CUDA backend each of them skips with a
// message.
#include <gtest/gtest.h>

#include <numeric>

#include "cuda/desk_run.h"
#include "cuda/open_device.h"
#include "cuda/recorded_run.h"
#include "cuda/same_mesh.h"
#include "mapping/ray_caster.h"

namespace tessera {
namespace {

using testing_support::DeskCamera;
using testing_support::DeskFrame;
using testing_support::DeskFrames;

class Gpu : public testing::Test {
  protected:
    void SetUp() override {
        Result<std::unique_ptr<Backend>> opened = OpenGpu(0);
        if (!opened.ok()) GTEST_SKIP() << opened.message();
        device_ = std::move(opened.value());
    }

    std::unique_ptr<Backend> device_;
};

TEST_F(Gpu, FusesTheBytesOfTheProcessor) {
    BlockMap expected{BlockMap::Config()}, map{BlockMap::Config()};
    Integrator integrator({}, DeskCamera());
    const std::unique_ptr<Integrator> on_device = device_->MakeIntegrator({}, DeskCamera());
    for (const DeskFrame& frame : DeskFrames()) {
        Integrator::View view;
        view.T_world_camera = frame.T_world_camera;
        integrator.Integrate(frame.prepared, view, expected);
        on_device->Integrate(frame.prepared, view, map);
    }
    on_device->Bring(map);
    testing_support::ExpectSameMap(map, expected);
}

TEST_F(Gpu, CastsTheBytesOfTheProcessor) {
    BlockMap map{BlockMap::Config()};
    testing_support::FusedDesk(10, map);
    RayCaster caster;
    PredictedView expected, view;
    for (const DeskFrame& frame : DeskFrames()) {
        caster.Predict(map, DeskCamera(), frame.T_world_camera, 0.1f, 6.0f, expected);
        device_->views().Predict(map, DeskCamera(), frame.T_world_camera, 0.1f, 6.0f, view);
        testing_support::ExpectSameView(view, expected);
    }
}

TEST_F(Gpu, MeshesTheBytesOfTheProcessor) {
    Pipeline pipeline({}, DeskCamera(), {}, device_.get());
    for (const DeskFrame& frame : DeskFrames()) pipeline.Process(frame.frame, frame.T_world_camera);
    const BlockMap& map = pipeline.map();
    std::vector<BlockId> blocks(static_cast<std::size_t>(map.size() - 1));
    std::iota(blocks.begin(), blocks.end(), 1);
    BlockMeshes meshes(static_cast<std::size_t>(map.size()));
    ASSERT_TRUE(device_->MakeBlockMesher()->MeshBlocks(map, blocks, 0, meshes));
    EXPECT_GT(testing_support::ExpectMeshesOf(map, blocks, 0, meshes), 5000u);
}

TEST_F(Gpu, WholeRunsAreTheProcessors) {
    for (const TrackingMethod method : {TrackingMethod::kSdf, TrackingMethod::kSdfGeometric,
                                        TrackingMethod::kIcp, TrackingMethod::kIcpRgb}) {
        PipelineConfig config;
        config.trackers.method = method;
        testing_support::DeskRun expected(config, nullptr), run(config, device_.get());
        testing_support::ExpectSameRun(run, expected);
    }
}

TEST_F(Gpu, ARecordingIsTheProcessorsRun) {
    if (!std::filesystem::exists(testing_support::RecordingFolder()))
        GTEST_SKIP() << testing_support::HowToGetTheRecording();
    for (const TrackingMethod method : {TrackingMethod::kSdf, TrackingMethod::kIcpRgb})
        testing_support::ExpectTheProcessorsRun(method, *device_);
}

}  // namespace
}  // namespace tessera
