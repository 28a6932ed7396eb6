#include "cuda/device_pipeline.h"

#include <gtest/gtest.h>

#include <cstring>

#include "cuda/desk_frames.h"
#include "cuda/same_map.h"
#include "tracking/sdf_simd.h"
#include "tracking/sdf_tracker.h"

namespace tessera::host {
namespace {

using testing_support::DeskCamera;
using testing_support::DeskFrame;
using testing_support::DeskFrames;
using testing_support::ExpectSameMap;
using testing_support::kPlenty;

Integrator::View MovingView(const DeskFrame& frame) {
    Integrator::View view;
    view.T_world_camera = frame.T_world_camera;
    view.motion.twist_per_s << 0.1, -0.2, 0.05, 0.2, 0.1, -0.1;
    view.motion.colour_delay_s = 0.01;
    view.motion.depth_readout_s = view.motion.colour_readout_s = 0.02;
    view.gain = 1.05f;
    view.offset = -0.02f;
    return view;
}

TEST(DeviceIntegrator, FusesTheBytesOfTheProcessor) {
    const BlockMap::Config config;
    BlockMap expected(config), map(config);
    Integrator integrator({}, DeskCamera());
    DevicePipeline device("host", kPlenty);
    const std::unique_ptr<Integrator> on_device = device.MakeIntegrator({}, DeskCamera());
    for (std::size_t i = 0; i < DeskFrames().size(); ++i) {
        const DeskFrame& frame = DeskFrames()[i];
        const Integrator::Report a =
            integrator.Integrate(frame.prepared, MovingView(frame), expected);
        const Integrator::Report b = on_device->Integrate(frame.prepared, MovingView(frame), map);
        ASSERT_EQ(a.new_blocks, b.new_blocks);
        ASSERT_EQ(a.refused_blocks, b.refused_blocks);
        ASSERT_EQ(a.fused_blocks, b.fused_blocks);
        EXPECT_EQ(integrator.changed_blocks(), on_device->changed_blocks());
        EXPECT_EQ(integrator.added_blocks(), on_device->added_blocks());
        if (i % 7 == 6) on_device->Bring(map);  // from time to time
    }
    on_device->Bring(map);
    ExpectSameMap(map, expected);
}

TEST(DeviceIntegrator, GoesOnWithAMapThatWasMadeElsewhere) {
    const BlockMap::Config config;
    BlockMap expected(config), map(config);
    Integrator first({}, DeskCamera()), same({}, DeskCamera());
    DevicePipeline device("host", kPlenty);
    const std::unique_ptr<Integrator> on_device = device.MakeIntegrator({}, DeskCamera());
    on_device->SetRevision(5);
    for (std::size_t i = 0; i < 10; ++i) {
        const DeskFrame& frame = DeskFrames()[i];
        same.Integrate(frame.prepared, MovingView(frame), expected);
        (i < 5 ? first : *on_device).Integrate(frame.prepared, MovingView(frame), map);
    }
    on_device->Bring(map);
    ExpectSameMap(map, expected);
}

// The same points, map and pose.
TEST(DevicePipeline, SumsAreTheProcessorsToTheBit) {
    BlockMap map{BlockMap::Config()};
    Integrator integrator({}, DeskCamera());
    for (std::size_t i = 0; i < 5; ++i)
        integrator.Integrate(DeskFrames()[i].prepared, MovingView(DeskFrames()[i]), map);
    const PreparedFrame& frame = DeskFrames()[5].prepared;
    FramePoints points;
    const PointArguments arguments = MakePointArguments(frame, DeskCamera(), {}, 2, {2.0}, true);
    points.Build(arguments);
    SdfArguments a{};
    static_cast<BlockMapView&>(a) = map.view();
    for (int i = 0; i < 3; ++i) a.rotation[4 * i] = 1 / a.voxel_size_m;
    a.x = points.x.data();
    a.y = points.y.data();
    a.z = points.z.data();
    a.intensity = points.intensity.data();
    a.weight = points.weight.data();
    a.use_intensity = true;
    a.normalise = true;
    a.gain = 1;
    a.distance_scale_m = 0.02f;
    a.intensity_scale = 0.1f;
    PointResiduals found;
    found.Resize(points.count());
    a.distance_residual = found.distance_m.data();
    a.intensity_residual = found.intensity.data();
    for (std::size_t k = 0; k < 3; ++k) a.gradient[k] = found.gradient[k].data();
    const PoseSums expected = SumPoints(points.count(), [&](int begin, int end, double* sums) {
        baseline::SumSdfPoints(a, begin, end, sums);
    });
    DevicePipeline device("host", kPlenty);
    FramePoints slots;
    device.SetPoints(map, frame, arguments, slots);
    EXPECT_EQ(slots.valid(), points.valid());
    const PoseSums sums = device.Sum(a, slots.count());
    EXPECT_GT(expected[SumLayout::kKnown], 1000);
    EXPECT_GT(expected[SumLayout::kColoured], 1000);
    EXPECT_EQ(std::memcmp(sums.value, expected.value, sizeof sums.value), 0);
    std::vector<float> device_distance(found.distance_m.size()),
        device_intensity(found.intensity.size());
    device.TakeResiduals(device_distance, device_intensity);
    EXPECT_EQ(
        std::memcmp(device_distance.data(), found.distance_m.data(), 4 * device_distance.size()),
        0);
    EXPECT_EQ(
        std::memcmp(device_intensity.data(), found.intensity.data(), 4 * device_intensity.size()),
        0);

    ResidualArguments residuals = MakeResidualArguments(frame, DeskCamera(), points, found);
    residuals.has_intensity = residuals.wants_shutter = true;
    for (int i = 0; i < 6; ++i) residuals.twist_per_s[i] = 0.1 * (i - 2);
    residuals.colour_delay_s = residuals.colour_readout_s = 0.01;
    residuals.gain = 1.1;
    residuals.residual_scale = 0.05;
    residuals.distance_scale_m = 0.01;
    residuals.intensity_scale = 0.05;
    for (int i = 0; i < 9; ++i) residuals.rotation[i] = 0.2 * (i % 4) - 0.1;
    const ResidualSums learnt = SumResiduals(residuals), there = device.SumResiduals(residuals);
    EXPECT_EQ(there.distances, learnt.distances);
    EXPECT_EQ(there.scores, learnt.scores);
    EXPECT_EQ(there.shutter, learnt.shutter);
    EXPECT_EQ(learnt.distances.size(), 13u * 4 * 20 * 15);
    EXPECT_EQ(learnt.scores.size(), 10u * 19 * 14);
    EXPECT_EQ(learnt.shutter.size(), 5u * 20);
    EXPECT_GT(learnt.shutter[5 * 10], 0);

    const ShadingArguments shading = MakeShadingArguments(points, found, 1.1, 0.1);
    const std::vector<float> before = points.intensity;
    RemoveShading(shading);
    device.RemoveShading(shading);
    device.TakePoints(slots);
    EXPECT_NE(points.intensity, before);
    EXPECT_EQ(slots.intensity, points.intensity);
}

// Tracks consecutive frames against the same map, from the same start.
TEST(DevicePipeline, TracksAsTheProcessorDoes) {
    BlockMap map{BlockMap::Config()};
    Integrator integrator({}, DeskCamera());
    DevicePipeline device("host", kPlenty);
    const TrackJudge judge({});
    ResidualModel model({}), device_model({});
    SdfTracker expected({}, DeskCamera(), judge, model, true);
    SdfTracker tracker({}, DeskCamera(), judge, device_model, true, &device);
    for (std::size_t i = 0; i < 8; ++i)
        integrator.Integrate(DeskFrames()[i].prepared, MovingView(DeskFrames()[i]), map);
    for (std::size_t i = 8; i < 14; ++i) {
        const Eigen::Isometry3d& last = DeskFrames()[i - 1].T_world_camera;
        const TrackInput input{DeskFrames()[i].prepared, map, {last}, last, 1.0 / 30, 1, {}};
        const TrackResult a = expected.Track(input);
        testing_support::ExpectSameTrack(tracker.Track(input), a, i);
    }
}

}  // namespace
}  // namespace tessera::host
