#include "recordings/sens_recording.h"

#include <gtest/gtest.h>

#include "recordings/sens_fixture.h"

namespace tessera {
namespace {

using SensRecordings = SensFixture;

TEST_F(SensRecordings, DepthIsBitExactAndColourToo) {
    for (const int colour_kind : {0, 1, 2})
        for (const int depth_kind : {0, 1}) {
            SensTestFile sens = Raw(3);
            sens.colour_kind = colour_kind;
            sens.depth_kind = depth_kind;
            for (int i = 0; i < 3; ++i) {
                SensTestFrame& frame = sens.frames[static_cast<std::size_t>(i)];
                if (depth_kind == 1) frame.depth = SensTestZlib(SensDepthOf(i));
                if (colour_kind == 1) frame.colour = SensTestPng(SensColourOf(i));
                if (colour_kind == 2) frame.colour = SensTestJpeg(SensColourOf(i));
            }
            const auto recording = Opened(sens);
            ASSERT_EQ(recording->info().pairs.size(), 3u);
            EXPECT_TRUE(recording->info().warnings.empty());
            for (const int i : {2, 0, 1}) {
                const Status status = recording->Load(static_cast<std::size_t>(i), depth, colour);
                ASSERT_TRUE(status.ok()) << status.message();
                EXPECT_EQ(depth, SensDepthOf(i));
                if (colour_kind < 2) {
                    EXPECT_EQ(colour, SensColourOf(i));
                } else {
                    ASSERT_EQ(colour.width(), 64);
                    EXPECT_NEAR(colour(20, 30).r, 60, 4);
                    EXPECT_NEAR(colour(20, 30).b, 40 * i, 4);
                }
            }
        }
}

TEST_F(SensRecordings, CalibrationAndStampsAreTheFiles) {
    SensTestFile sens = Raw(3);
    sens.depth_shift = 4000;
    sens.frames[1].colour_stamp_us = 0;  // was never set
    const auto recording = Opened(sens);
    const RecordingInfo& info = recording->info();
    EXPECT_EQ(info.kind, "ScanNet recording");
    EXPECT_EQ(
        info.depth_camera.pinhole,
        (PinholeCamera{.width = 32, .height = 24, .fx = 36, .fy = 37, .cx = 15.25, .cy = 11.5}));
    EXPECT_EQ(
        info.colour_camera.pinhole,
        (PinholeCamera{.width = 64, .height = 48, .fx = 70, .fy = 71, .cx = 31.5, .cy = 23.25}));
    EXPECT_EQ(info.depth_camera.depth_scale, 4000);
    EXPECT_TRUE(info.camera_known);
    EXPECT_TRUE(info.T_colour_depth.matrix().isIdentity(0));
    ASSERT_EQ(info.pairs.size(), 3u);
    EXPECT_DOUBLE_EQ(info.pairs[2].depth_stamp_s, 2.2);
    EXPECT_DOUBLE_EQ(info.pairs[2].colour_stamp_s, 2.2005);
    EXPECT_DOUBLE_EQ(info.pairs[1].colour_stamp_s, 2.1);
    EXPECT_NEAR(info.fps, 10, 1e-9);
}

// ScanNet multiplies points of the depth camera with depth's extrinsic to get the colour camera's.
TEST_F(SensRecordings, AnExtrinsicTakesPointsToTheCommonFrame) {
    Eigen::Isometry3f T_common_colour = Eigen::Isometry3f::Identity(), T_common_depth;
    T_common_depth =
        Eigen::Translation3f(0.04f, 0, 0.01f) * Eigen::AngleAxisf(0.1f, Eigen::Vector3f::UnitY());
    for (const bool colour_moved : {false, true}) {
        if (colour_moved)
            T_common_colour = Eigen::Translation3f(0, 0.02f, 0) *
                              Eigen::AngleAxisf(-0.2f, Eigen::Vector3f::UnitX());
        SensTestFile sens = Raw(1);
        sens.depth_extrinsic = T_common_depth.matrix();
        sens.colour_extrinsic = T_common_colour.matrix();
        const auto recording = Opened(sens);
        const Eigen::Vector3d p_depth(0.2, -0.1, 1.5);
        const Eigen::Vector3f p_common = T_common_depth * p_depth.cast<float>();
        const Eigen::Vector3f p_colour = T_common_colour.inverse() * p_common;
        EXPECT_NEAR((recording->info().T_colour_depth * p_depth - p_colour.cast<double>()).norm(),
                    0, 1e-6);
        EXPECT_TRUE(recording->info().warnings.empty());
    }
    SensTestFile sens = Raw(1);
    sens.depth_extrinsic.setZero();
    const auto recording = Opened(sens);
    EXPECT_TRUE(recording->info().T_colour_depth.matrix().isIdentity(0));
    EXPECT_EQ(recording->info().warnings.size(), 1u);
}

TEST_F(SensRecordings, WithoutUsableStampsFramesAreEvenlySpaced) {
    SensTestFile sens = Raw(3);
    for (SensTestFrame& frame : sens.frames) frame.colour_stamp_us = frame.depth_stamp_us = 0;
    auto recording = Opened(sens);
    EXPECT_DOUBLE_EQ(recording->info().pairs[2].depth_stamp_s, 2 / 30.0);
    EXPECT_EQ(recording->info().fps, 30);
    EXPECT_EQ(
        recording->info().notes,
        std::vector<std::string>{"the file has no time stamps; 30 frames per second are assumed"});
    EXPECT_TRUE(recording->info().warnings.empty());
    sens = Raw(3);
    std::swap(sens.frames[1].depth_stamp_us, sens.frames[2].depth_stamp_us);
    recording = Opened(sens);
    EXPECT_DOUBLE_EQ(recording->info().pairs[2].colour_stamp_s, 2 / 30.0);
    EXPECT_EQ(recording->info().warnings.size(), 1u);
}

TEST_F(SensRecordings, ARecordingWithoutColourHasNone) {
    SensTestFile sens = Raw(1);
    sens.colour_width = sens.colour_height = 0;
    sens.frames[0].colour.clear();
    const auto recording = Opened(sens);
    EXPECT_FALSE(recording->info().has_colour);
    ASSERT_TRUE(recording->Load(0, depth, colour).ok());
    EXPECT_EQ(depth, SensDepthOf(0));
    EXPECT_TRUE(colour.empty());
    EXPECT_EQ(recording->info().colour_camera.pinhole, recording->info().depth_camera.pinhole);
}

}  // namespace
}  // namespace tessera
