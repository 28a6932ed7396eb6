#include "cuda/device_icp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "cuda/desk_frames.h"
#include "cuda/device_pipeline.h"
#include "mapping/ray_caster.h"
#include "tracking/icp_simd.h"
#include "tracking/icp_tracker.h"
#include "tracking/set_view.h"

namespace tessera::host {
namespace {

using testing_support::DeskCamera;
using testing_support::DeskFrames;
using testing_support::FusedDesk;
using testing_support::kPlenty;

constexpr float kNear_m = 0.3f, kFar_m = 5.0f, kJump_m = 0.1f;
constexpr int kLevels = 3;

// The predicted view of the desk from the pose of its fifth frame, and the points of the sixth
// frame.
struct IcpRig {
    IcpRig() {
        FusedDesk(5, map);
        PredictedView view;
        RayCaster().Predict(map, camera, T_world_view, kNear_m, kFar_m, view);
        BuildIcpModel(view, kLevels, kJump_m, model);
        points.Build(PointsOf(0));
        distance.resize(static_cast<std::size_t>(points.count()));
        intensity = kept_distance = kept_intensity = distance;
    }

    PointArguments PointsOf(int level) const {
        PointArguments a =
            MakePointArguments(DeskFrames()[5].prepared, DeskCamera(), {}, 2 << level, {2.0}, true);
        a.normal_radius_px = 4;
        return a;
    }

    void PredictOn(DeviceIcp& icp) const {
        PredictedView view;
        std::vector<IcpModelLevel> levels;
        icp.Predict(map, camera, T_world_view, {kNear_m, kFar_m, kJump_m}, kLevels, view, levels);
        ASSERT_EQ(levels.size(), model.size());
        for (std::size_t i = 0; i < model.size(); ++i) EXPECT_EQ(levels[i].camera, model[i].camera);
    }
    // Returns how many are valid.
    std::int64_t SetPoints(DeviceIcp& icp, int level) const {
        FramePoints slots;
        icp.SetPoints(DeskFrames()[5].prepared, PointsOf(level), level, slots);
        return slots.valid();
    }

    // At a pose that is off by `moved_m` along x.
    IcpArguments ArgumentsAt(float moved_m, bool compare, std::size_t level_of_model = 0) {
        const IcpModelLevel& level = model[level_of_model];
        IcpArguments a{};
        SetModel(level, a);
        SetPose(Eigen::Isometry3d(Eigen::Translation3d(moved_m, 0, 0)), a);
        a.x = points.x.data();
        a.y = points.y.data();
        a.z = points.z.data();
        a.normal_x = points.normal_x.data();
        a.normal_y = points.normal_y.data();
        a.normal_z = points.normal_z.data();
        a.intensity_of_point = points.intensity.data();
        a.weight = points.weight.data();
        a.distance_gate_m = 0.1f;
        a.normal_gate_cosine = 0.7f;
        a.distance_scale_m = 0.02f;
        a.intensity_scale = 0.1f;
        a.intensity_gate = 0.5f;
        a.alpha = 0.05f;
        a.gain = 1.02f;
        a.offset = -0.01f;
        a.band = {0.04f, 0.02f, 0.1f};
        a.distance_residual = distance.data();
        a.intensity_residual = intensity.data();
        for (auto& values : gradient) values.resize(distance.size());
        for (std::size_t k = 0; k < 3; ++k) a.gradient[k] = gradient[k].data();
        a.distance_before = compare ? kept_distance.data() : nullptr;
        a.intensity_before = compare ? kept_intensity.data() : nullptr;
        return a;
    }

    PoseSums Expected(const IcpArguments& a) const {
        return SumPoints(points.count(), [&](int begin, int end, double* sums) {
            baseline::SumIcpPoints(a, begin, end, sums);
        });
    }

    PinholeCamera camera = DeskCamera().Every(2);
    Eigen::Isometry3d T_world_view = DeskFrames()[4].T_world_camera;
    BlockMap map{BlockMap::Config()};
    std::vector<IcpModelLevel> model;
    FramePoints points;
    std::vector<float> distance, intensity, kept_distance, kept_intensity, gradient[3];
};

TEST(DeviceIcp, ModelIsTheProcessorsToTheBit) {
    const IcpRig rig;
    DevicePipeline device("host", kPlenty);
    DeviceIcp icp(device);
    rig.PredictOn(icp);
    // SetPoints also waits for the model.
    EXPECT_GT(rig.SetPoints(icp, 0), 0);
    ASSERT_EQ(icp.model().size(), rig.model.size());
    for (std::size_t i = 0; i < rig.model.size(); ++i) {
        const ModelImages& level = icp.model()[i];
        const IcpModelLevel& expected = rig.model[i];
        ASSERT_EQ(level.width, expected.camera.width);
        ASSERT_EQ(level.height, expected.camera.height);
        const std::size_t bytes = expected.depth_m.size() * sizeof(float);
        EXPECT_EQ(std::memcmp(level.depth_m, expected.depth_m.data(), bytes), 0) << i;
        EXPECT_EQ(std::memcmp(level.normal, expected.normal_camera.data(), 3 * bytes), 0) << i;
        EXPECT_EQ(std::memcmp(level.intensity, expected.intensity.data(), bytes), 0) << i;
        const float* begin = expected.intensity.data();  // some pixels are trusted, some are not
        const auto untrusted = std::count(begin, begin + expected.intensity.size(), -1.0f);
        EXPECT_GT(untrusted, 50) << i;
        EXPECT_LT(untrusted, 0.75 * static_cast<double>(expected.intensity.size())) << i;
    }
}

void ExpectSameSums(const PoseSums& sums, const PoseSums& expected) {
    for (const int count : {SumLayout::kKnown, SumLayout::kInliers, SumLayout::kColoured})
        EXPECT_GT(expected[count], 1000);
    EXPECT_EQ(std::memcmp(sums.value, expected.value, sizeof sums.value), 0);
}

// The same points, model and pose, first alone and then compared with the residuals of another
// pose.
TEST(DeviceIcp, SumsAreTheProcessorsToTheBit) {
    IcpRig rig;
    DevicePipeline device("host", kPlenty);
    DeviceIcp icp(device);
    rig.PredictOn(icp);
    EXPECT_EQ(rig.SetPoints(icp, 0), rig.points.valid());
    const PoseSums first = rig.Expected(rig.ArgumentsAt(0.004f, false));
    EXPECT_EQ(first[SumLayout::kEnergyBefore], 0);
    ExpectSameSums(icp.Sum(rig.ArgumentsAt(0.004f, false), rig.points.count()), first);
    std::swap(rig.distance, rig.kept_distance);
    std::swap(rig.intensity, rig.kept_intensity);
    PointResiduals unused;
    icp.KeepResiduals(unused, unused);
    const PoseSums second = rig.Expected(rig.ArgumentsAt(0, true));
    EXPECT_GT(std::abs(second[SumLayout::kEnergyBefore] - second[SumLayout::kEnergy]),
              1e-3 * second[SumLayout::kEnergy]);
    for (int i = 0; i < 2; ++i)
        ExpectSameSums(icp.Sum(rig.ArgumentsAt(0, true), rig.points.count()),
                       second);  // residuals that are not kept change nothing

    std::vector<float> distance(rig.distance.size()), intensity(rig.intensity.size());
    icp.TakeResiduals(distance, intensity);  // returns the kept residuals
    const std::size_t bytes = distance.size() * sizeof(float);
    EXPECT_EQ(std::memcmp(distance.data(), rig.kept_distance.data(), bytes), 0);
    EXPECT_EQ(std::memcmp(intensity.data(), rig.kept_intensity.data(), bytes), 0);
    icp.KeepResiduals(unused, unused);
    icp.TakeResiduals(distance, intensity);
    EXPECT_EQ(std::memcmp(distance.data(), rig.distance.data(), bytes), 0);
    EXPECT_EQ(std::memcmp(intensity.data(), rig.intensity.data(), bytes), 0);
}

TEST(DeviceIcp, AModelOfTheProcessorGivesTheSameSums) {
    IcpRig rig;
    DevicePipeline device("host", kPlenty), other("host", kPlenty);
    DeviceIcp predicted(device), uploaded(other);
    rig.PredictOn(predicted);
    uploaded.SetModel(rig.model);
    for (int level = 0; level < kLevels; ++level) {
        const IcpArguments a = rig.ArgumentsAt(0, false, static_cast<std::size_t>(level));
        std::int64_t valid = 0;
        for (DeviceIcp* icp : {&predicted, &uploaded}) valid = rig.SetPoints(*icp, level);
        const PoseSums x = predicted.Sum(a, rig.points.count()),
                       y = uploaded.Sum(a, rig.points.count());
        EXPECT_GT(x[SumLayout::kInliers], 0.5 * static_cast<double>(valid)) << level;
        EXPECT_EQ(std::memcmp(x.value, y.value, sizeof x.value), 0) << level;
    }
}

struct IcpTrackers : testing::TestWithParam<bool> {
    bool colour() const { return GetParam(); }
};

INSTANTIATE_TEST_SUITE_P(DeviceIcp, IcpTrackers, testing::Bool(),
                         [](const auto& test) { return test.param ? "IcpRgb" : "Icp"; });

// Tracks consecutive frames against the same map, from the same starting poses.
TEST_P(IcpTrackers, TracksAsTheProcessorDoes) {
    BlockMap map{BlockMap::Config()};
    FusedDesk(8, map);
    DevicePipeline device("host", kPlenty);
    const TrackJudge judge({});
    ResidualModel model({}), device_model({});
    IcpTracker expected({}, DeskCamera(), judge, model, colour(), std::make_unique<RayCaster>());
    IcpTracker tracker({}, DeskCamera(), judge, device_model, colour(), nullptr,
                       &device.icp_sums());
    for (std::size_t i = 8; i < 14; ++i) {
        const Eigen::Isometry3d& last = DeskFrames()[i - 1].T_world_camera;
        const Eigen::Isometry3d away = last * Eigen::Translation3d(0.02, 0.01, -0.02);
        const TrackInput input{DeskFrames()[i].prepared, map, {away, last}, last, 1.0 / 30, 1, {}};
        const TrackResult a = expected.Track(input);
        testing_support::ExpectSameTrack(tracker.Track(input), a, i);
        EXPECT_EQ(a.intensity_rms > 0, colour());
    }
}

TEST_P(IcpTrackers, IsLostWhereTheModelHasNoRoom) {
    BlockMap map{BlockMap::Config()};
    FusedDesk(3, map);
    DevicePipeline device("host", std::size_t{1} << 20);
    ResidualModel model({});
    IcpTracker tracker({}, DeskCamera(), TrackJudge({}), model, colour(), nullptr,
                       &device.icp_sums());
    const Eigen::Isometry3d& last = DeskFrames()[2].T_world_camera;
    const TrackResult result =
        tracker.Track({DeskFrames()[3].prepared, map, {last, last}, last, 1.0 / 30, 1, {}});
    EXPECT_EQ(result.status, TrackStatus::kLost);
}

}  // namespace
}  // namespace tessera::host
