#include "synth/synthetic_source.h"

#include <gtest/gtest.h>

#include "io/trajectory.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

SynthConfig Small() {
    SynthConfig config;
    config.camera = {64, 48, 52.5, 52.5, 31.5, 23.5};
    config.frames = 6;
    return config;
}

TEST(SyntheticSource, HandsOutItsFramesWithTheirTruth) {
    auto source = OpenSyntheticScene("synthetic:corner", Small());
    ASSERT_TRUE(source.ok()) << source.message();
    EXPECT_EQ(source.value()->info().frame_count, 6);
    EXPECT_TRUE(source.value()->info().has_truth);
    Frame frame;
    double last_stamp = 0;
    for (int i = 0; i < 6; ++i) {
        ASSERT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
        EXPECT_EQ(frame.index, i);
        EXPECT_GT(frame.stamp_s, last_stamp);
        EXPECT_EQ(frame.colour.width(), 64);
        EXPECT_EQ(frame.depth_m.height(), 48);
        ASSERT_TRUE(frame.T_world_camera.has_value());
        // Every pixel of the corner lies on one of its three planes: x = 0, y = 0, z = 0.
        for (const auto& [x, y] : {std::pair{5, 5}, {60, 10}, {32, 24}, {30, 45}}) {
            const Eigen::Vector3d p =
                *frame.T_world_camera * Small().camera.Unproject(x, y, frame.depth_m(x, y));
            EXPECT_LT(p.cwiseAbs().minCoeff(), 1e-5) << p.transpose();
        }
        last_stamp = frame.stamp_s;
    }
    EXPECT_EQ(source.value()->Read(frame).status, ReadStatus::kEnd);
}

TEST(SyntheticSource, GoesTheSameWayFasterAndMeasuresInItsOwnScale) {
    SynthConfig config = Small();
    config.frames = 0;
    auto slow = OpenSyntheticScene("corner", config);
    config.speed = 2;
    config.rig.depth_scale = 1.25;
    auto fast = OpenSyntheticScene("corner", config);
    ASSERT_TRUE(slow.ok() && fast.ok());
    EXPECT_EQ(fast.value()->info().frame_count, slow.value()->info().frame_count / 2);
    Frame a, b;
    ASSERT_TRUE(slow.value()->Seek(20) && fast.value()->Seek(10));
    ASSERT_EQ(slow.value()->Read(a).status, ReadStatus::kOk);
    ASSERT_EQ(fast.value()->Read(b).status, ReadStatus::kOk);
    EXPECT_NEAR((a.T_world_camera->matrix() - b.T_world_camera->matrix()).norm(), 0, 1e-12);
    EXPECT_FLOAT_EQ(b.depth_m(30, 20), 1.25f * a.depth_m(30, 20));
}

TEST(SyntheticSource, SeekGivesTheSameFrameAgain) {
    SynthConfig config = Small();
    config.sensor.noise = NoiseModel::kKinect;
    auto source = OpenSyntheticScene("floor", config);
    ASSERT_TRUE(source.ok()) << source.message();
    Frame first, again;
    for (int i = 0; i < 4; ++i) ASSERT_EQ(source.value()->Read(first).status, ReadStatus::kOk);
    ASSERT_TRUE(source.value()->Seek(3));
    ASSERT_EQ(source.value()->Read(again).status, ReadStatus::kOk);
    EXPECT_EQ(first.depth_m, again.depth_m);
    EXPECT_EQ(first.colour, again.colour);
    EXPECT_EQ(first.stamp_s, again.stamp_s);
    EXPECT_FALSE(source.value()->Seek(-1));
    EXPECT_FALSE(source.value()->Seek(7));
}

TEST(SyntheticSource, ATrajectoryFileReplacesTheMotion) {
    const std::string file = ProcessFolder() + "/source_path.txt";
    const Eigen::Isometry3d a = LookAt({1, -1, 1}, {0, 0, 0.5}),
                            b = LookAt({1.2, -1, 1}, {0, 0, 0.5});
    ASSERT_TRUE(WriteTrajectory(file, {{5.0, a}, {5.2, b}}).ok());
    SynthConfig config = Small();
    config.frames = 0;
    config.trajectory = file;
    auto source = OpenSyntheticScene("corner", config);
    ASSERT_TRUE(source.ok()) << source.message();
    EXPECT_EQ(source.value()->info().frame_count, 6);
    Frame frame;
    ASSERT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
    EXPECT_TRUE(frame.T_world_camera->isApprox(a, 1e-6));

    config.trajectory_from_start = true;
    const Eigen::Isometry3d start = MakeBuiltinScene("corner").value().path.T_world_camera(0);
    source = OpenSyntheticScene("corner", config);
    ASSERT_TRUE(source.ok());
    ASSERT_EQ(source.value()->Read(frame).status, ReadStatus::kOk);
    EXPECT_TRUE(frame.T_world_camera->isApprox(start, 1e-6));
}

TEST(SyntheticSource, BadNamesAndFilesAreErrors) {
    EXPECT_NE(OpenSyntheticScene("synthetic:attic", Small()).message().find("desk, room"),
              std::string::npos);
    EXPECT_NE(
        OpenSyntheticScene("/nowhere/house.OBJ", Small()).message().find("/nowhere/house.OBJ"),
        std::string::npos);
    SynthConfig config = Small();
    config.trajectory = "/nowhere/path.txt";
    EXPECT_NE(OpenSyntheticScene("wall", config).message().find("/nowhere/path.txt"),
              std::string::npos);
    config = Small();
    config.sensor.min_depth_m = 6;
    EXPECT_NE(OpenSyntheticScene("wall", config).message().find("min_depth_m"), std::string::npos);
    config = {};
    config.camera.width = 160;  // the centre stays where 640 columns have it
    EXPECT_NE(OpenSyntheticScene("wall", config).message().find("synthetic.cx"), std::string::npos);
}

TEST(SynthConfig, DescribesEveryKey) {
    SynthConfig config;
    ConfigParameters parameters;
    parameters.Section("synth", [&](ConfigParameters& p) { config.Describe(p); });
    ASSERT_TRUE(parameters.Set("synth.sensor.noise", "kinect").ok());
    ASSERT_TRUE(parameters.Set("synth.width", "320").ok());
    EXPECT_EQ(config.sensor.noise, NoiseModel::kKinect);
    EXPECT_EQ(config.camera.width, 320);
    EXPECT_FALSE(parameters.Set("synth.sensor.noise", "lidar").ok());
}

}  // namespace
}  // namespace tessera
