#include "tracking/sdf_tracker.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mapping/integrator.h"
#include "support/box_room.h"

namespace tessera {
namespace {

using testing_support::BoxRoom;
using testing_support::SmallCamera;
using testing_support::SmoothPath;

Integrator::View At(const Eigen::Isometry3d& T_world_camera) {
    Integrator::View view;
    view.T_world_camera = T_world_camera;
    return view;
}

PreparedFrame Prepare(const Frame& frame) {
    PreparedFrame prepared;
    PrepareFrame(frame, {}, prepared);
    return prepared;
}

// A map fused from exact views, and the camera that made it.
struct World {
    BoxRoom room;
    PinholeCamera camera = SmallCamera();
    BlockMap map{{.voxel_size_m = 0.02, .truncation_m = 0.08}};

    explicit World(const BoxRoom& r) : room(r) {
        Integrator integrator({}, camera);
        for (int i = 0; i < 12; ++i)
            integrator.Integrate(Prepare(room.Render(camera, SmoothPath(6 * i))),
                                 At(SmoothPath(6 * i)), map);
    }

    TrackResult Track(SdfTracker& tracker, const Eigen::Isometry3d& T_true, const Eigen::Isometry3d& T_start) const {
        const PreparedFrame frame = Prepare(room.Render(camera, T_true));
        return tracker.Track({.frame = frame,
                              .map = map,
                              .T_world_camera_starts = {T_start},
                              .T_world_camera_last = T_start,
                              .since_last_s = 1.0 / 30, .motion = {}});
    }
};

SdfTracker::Config FineConfig(double alpha) {
    SdfTracker::Config config;
    config.alpha_mode = SdfTracker::AlphaMode::kFixed;
    config.alpha = alpha;
    config.finest_step_px = 1;
    config.fine_iterations = 30;
    return config;
}

// No offset, then plus and minus each axis: 3 cm and 30 mrad, most of the band.
std::vector<Vector6d> ThirteenStarts() {
    std::vector<Vector6d> starts = {Vector6d::Zero()};
    for (int axis = 0; axis < 6; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            Vector6d twist = Vector6d::Zero();
            twist(axis) = 0.03 * sign;
            starts.push_back(twist);
        }
    return starts;
}

class SdfTrackerStarts : public testing::TestWithParam<double> {};

TEST_P(SdfTrackerStarts, ThirteenStartsComeBack) {
    BoxRoom room;
    room.has_ball = true;
    const World world(room);
    const Eigen::Isometry3d T_true = SmoothPath(20);
    for (const Vector6d& offset : ThirteenStarts()) {
        SdfTracker tracker(FineConfig(GetParam()), world.camera);
        const TrackResult result = world.Track(tracker, T_true, T_true * Se3Exp(offset));
        ASSERT_EQ(result.status, TrackStatus::kGood) << result.reason;
        const Eigen::Isometry3d error = T_true.inverse() * result.T_world_camera;
        EXPECT_LT(error.translation().norm(), 0.0015) << offset.transpose();
        EXPECT_LT(RotationAngle(T_true, result.T_world_camera), 0.0015) << offset.transpose();
    }
}

INSTANTIATE_TEST_SUITE_P(Alpha, SdfTrackerStarts, testing::Values(0.0, 0.1));

// [B14]'s main claim: one textured plane holds all six motions with colour, three without.
TEST(SdfTracker, PlaneIsHeldByItsTextureOnly) {
    BoxRoom room;
    room.only_back_wall = true;
    const World world(room);
    const Eigen::Isometry3d T_true = SmoothPath(20);
    Vector6d offset;
    offset << 0, 0, 0.02, 0.02, -0.02, 0.01;
    SdfTracker colour(FineConfig(0.1), world.camera);
    const TrackResult with = world.Track(colour, T_true, T_true * Se3Exp(offset));
    EXPECT_EQ(with.status, TrackStatus::kGood) << with.reason;
    EXPECT_LT((T_true.inverse() * with.T_world_camera).translation().norm(), 0.002);

    SdfTracker geometry(FineConfig(0.0), world.camera);
    const TrackResult without = world.Track(geometry, T_true, T_true * Se3Exp(offset));
    EXPECT_TRUE(without.degenerate);
    EXPECT_EQ(without.status, TrackStatus::kPoor);
    EXPECT_NE(without.reason.find("degenerate"), std::string::npos);
}

TEST(SdfTracker, BareRoomIsHeldByItsShape) {
    BoxRoom room;
    room.has_ball = true;
    room.texture = 0;
    const World world(room);
    const Eigen::Isometry3d T_true = SmoothPath(20);
    SdfTracker tracker(FineConfig(0.1), world.camera);
    const TrackResult result = world.Track(tracker, T_true, SmoothPath(19));
    EXPECT_EQ(result.status, TrackStatus::kGood) << result.reason;
    EXPECT_LT((T_true.inverse() * result.T_world_camera).translation().norm(), 0.002);
}

TEST(SdfTracker, ExposureChangeIsExplainedByBrightness) {
    BoxRoom room;
    room.has_ball = true;
    const World world(room);
    const Eigen::Isometry3d T_true = SmoothPath(20);
    Frame frame = world.room.Render(world.camera, T_true);
    for (std::size_t i = 0; i < frame.colour.size(); ++i) {
        Rgb8& c = frame.colour.data()[i];
        c.r = c.g = c.b = static_cast<std::uint8_t>(0.8 * c.r + 10.0 + 0.5);
    }
    const PreparedFrame prepared = Prepare(frame);
    SdfTracker::Config config = FineConfig(0.3);
    config.brightness_prior = 1e-3;
    SdfTracker tracker(config, world.camera);
    const TrackResult result = tracker.Track({.frame = prepared,
                                              .map = world.map,
                                              .T_world_camera_starts = {SmoothPath(19)},
                                              .T_world_camera_last = SmoothPath(19),
                                              .since_last_s = 1.0 / 30, .motion = {}});
    // map = gain * image + offset, so gain = 1 / 0.8 and offset = -10 / 255 / 0.8, up to the prior's pull.
    EXPECT_NEAR(result.gain, 1.25, 0.07);
    EXPECT_LT((T_true.inverse() * result.T_world_camera).translation().norm(), 0.002);
}

// The colour image of a moving camera, taken 15 ms after the depth image.
TEST(SdfTracker, ColourDelayIsAllowedFor) {
    BoxRoom room;
    room.only_back_wall = true;  // only colour holds the sideways motion
    const World world(room);
    Vector6d step;  // per frame
    step << 0, 0.02, 0, 0.02, 0, 0;
    const Eigen::Isometry3d T_last = SmoothPath(10), T_true = T_last * Se3Exp(step);
    const double delay_share = 0.45;
    Frame frame = world.room.Render(world.camera, T_true);
    frame.colour = world.room.Render(world.camera, T_true * Se3Exp(step * delay_share)).colour;
    const PreparedFrame prepared = Prepare(frame);
    const auto error = [&](bool allow) {
        SdfTracker tracker(FineConfig(0.3), world.camera);
        const TrackResult result = tracker.Track({.frame = prepared,
                                                  .map = world.map,
                                                  .T_world_camera_starts = {T_true},
                                                  .T_world_camera_last = T_last,
                                                  .since_last_s = 1.0 / 30,
                                                  .motion = {.colour_delay_s = allow ? delay_share / 30 : 0}});
        return (T_true.inverse() * result.T_world_camera).translation().norm();
    };
    EXPECT_LT(error(true), 0.003);
    EXPECT_GT(error(false), 2 * error(true));
}

TEST(SdfTracker, LosesWhatIsNotThere) {
    BoxRoom room;
    const World world(room);
    SdfTracker tracker(FineConfig(0.1), world.camera);
    Eigen::Isometry3d T_elsewhere = Eigen::Isometry3d::Identity();
    T_elsewhere.translation() << 50, 0, 0;
    const TrackResult result = world.Track(tracker, SmoothPath(20), T_elsewhere);
    EXPECT_EQ(result.status, TrackStatus::kLost);
    EXPECT_FALSE(result.reason.empty());
}

TEST(SdfTracker, ThreadsDoNotChangeABit) {
    BoxRoom room;
    room.has_ball = true;
    const World world(room);
    Eigen::Isometry3d poses[2];
    for (int k = 0; k < 2; ++k) {
        tbb::global_control threads(tbb::global_control::max_allowed_parallelism, k == 0 ? 1 : 4);
        SdfTracker tracker(FineConfig(0.1), world.camera);
        poses[k] = world.Track(tracker, SmoothPath(20), SmoothPath(18)).T_world_camera;
    }
    EXPECT_EQ(poses[0].matrix(), poses[1].matrix());
}

TEST(SdfTracker, AutoAlphaGrowsWhenNeighboursShareDistanceErrors) {
    BoxRoom room;
    room.has_ball = true;
    const World world(room);
    const auto settle = [&](double bump_m) {
        SdfTracker::Config config = FineConfig(0.1);
        config.alpha_mode = SdfTracker::AlphaMode::kAuto;
        SdfTracker tracker(config, world.camera);
        Frame frame = world.room.Render(world.camera, SmoothPath(20));
        for (int v = 0; v < frame.depth_m.height(); ++v)
            for (int u = 0; u < frame.depth_m.width(); ++u)
                frame.depth_m(u, v) += static_cast<float>(bump_m * std::sin(0.05 * u) * std::cos(0.06 * v));
        const PreparedFrame prepared = Prepare(frame);
        TrackResult result;
        for (int i = 0; i < 3; ++i)
            result = tracker.Track({.frame = prepared,
                                    .map = world.map,
                                    .T_world_camera_starts = {SmoothPath(20)},
                                    .T_world_camera_last = SmoothPath(20),
                                    .since_last_s = 1.0 / 30, .motion = {}});
        return result.alpha;
    };
    EXPECT_GT(settle(0.02), 2 * settle(0.0));
}

}  // namespace
}  // namespace tessera
