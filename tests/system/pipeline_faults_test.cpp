// Frames that show nothing or something false.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "support/box_room.h"
#include "system/pipeline.h"
#include "system/room_frames.h"

namespace tessera {
namespace {

using testing_support::BoxRoom;
using testing_support::SmallCamera;
using testing_support::SmoothPath;

void FillDepth(Frame& frame, std::uint32_t seed) {
    for (float& z : std::span(frame.depth_m.data(), frame.depth_m.size())) {
        seed = seed * 1664525u + 1013904223u;
        z = 0.3f + static_cast<float>(seed >> 8) * (4.0f / (1 << 24));
    }
}

TEST(Pipeline, BadFramesAreLostWithAReasonAndHarmNothing) {
    Pipeline pipeline(SmallConfig(), SmallCamera());
    for (int i = 0; i < 10; ++i) pipeline.Process(RoomFrame(i));
    const BlockId blocks = pipeline.map().size();
    const auto expect_lost = [&](Frame frame, const char* reason) {
        const FrameReport report = pipeline.Process(frame);
        EXPECT_EQ(report.track.status, TrackStatus::kLost);
        EXPECT_FALSE(report.fused);
        EXPECT_NE(report.track.reason.find(reason), std::string::npos) << report.track.reason;
        EXPECT_EQ(pipeline.map().size(), blocks);
    };
    Frame frame = RoomFrame(10);
    frame.depth_m = DepthImage(160, 120, 0.0f);
    expect_lost(frame, "0 depth pixels in the image");
    frame.depth_m = DepthImage(160, 120, 65.535f);
    expect_lost(frame, "depth_scale");
    FillDepth(frame, 7);
    expect_lost(frame, "noise");
    frame.depth_m = DepthImage(160, 120, std::numeric_limits<float>::quiet_NaN());
    expect_lost(frame, "0 depth pixels");
    EXPECT_EQ(pipeline.Process(RoomFrame(12)).track.status, TrackStatus::kGood);
}

TEST(Pipeline, NoiseDoesNotBecomeTheWorld) {
    Pipeline pipeline(SmallConfig(), SmallCamera());
    Frame noise = RoomFrame(0);
    FillDepth(noise, 3);
    EXPECT_FALSE(pipeline.Process(noise).fused);
    const FrameReport report = pipeline.Process(RoomFrame(1));
    EXPECT_TRUE(report.first);
    EXPECT_TRUE(report.fused);
    EXPECT_TRUE(report.track.T_world_camera.isApprox(Eigen::Isometry3d::Identity()));
}

// For a third of a second the colour camera is covered, dazzled, or hangs.
TEST(Pipeline, WrongColoursNeitherMoveTheCameraNorPaintTheMap) {
    const auto mean_green = [](Pipeline& pipeline) {
        const TriangleMesh mesh = pipeline.mapping().Mesh();
        double sum = 0;
        for (const Rgb8& colour : mesh.colours) sum += colour.g;
        return sum / static_cast<double>(mesh.colours.size());
    };
    double usual = 0;
    for (const char* fault : {"none", "dark", "dazzled", "hangs"}) {
        SCOPED_TRACE(fault);
        Pipeline pipeline(SmallConfig(), SmallCamera());
        Frame before = RoomFrame(0);
        for (int i = 0; i < 30; ++i) {
            Frame frame = RoomFrame(i);
            const bool faulty = i >= 10 && i < 20 && fault != std::string("none");
            if (faulty && fault == std::string("hangs"))
                frame.colour = before.colour;
            else if (faulty)
                std::ranges::fill(
                    std::span(frame.colour.data(), frame.colour.size()),
                    fault == std::string("dark") ? Rgb8{3, 3, 3} : Rgb8{255, 255, 255});
            before = frame;
            const FrameReport report = pipeline.Process(frame);
            ASSERT_EQ(report.track.status, TrackStatus::kGood) << i << ": " << report.track.reason;
            EXPECT_TRUE(report.fused);
            // That it hangs shows after half a second.
            EXPECT_EQ(report.track.colour_rejected, faulty && fault != std::string("hangs")) << i;
            const Eigen::Isometry3d truth = SmoothPath(0).inverse() * SmoothPath(i);
            EXPECT_LT((truth.inverse() * report.track.T_world_camera).translation().norm(), 0.006)
                << i;
        }
        if (fault == std::string("none")) usual = mean_green(pipeline);
        EXPECT_NEAR(mean_green(pipeline), usual, 2);
    }
}

// A colour camera of half the rate, and one that hangs from the third frame on.
TEST(Pipeline, ARepeatedImageIsCalledWrongOnlyIfTheCameraHangs) {
    for (const bool hangs : {false, true}) {
        Pipeline pipeline(SmallConfig(), SmallCamera());
        for (int i = 0; i < 21; ++i) {
            Frame frame = RoomFrame(i);
            frame.colour = RoomFrame(hangs ? std::min(i, 2) : i / 2 * 2).colour;
            const FrameReport report = pipeline.Process(frame);
            ASSERT_TRUE(report.tracked()) << i << ": " << report.track.reason;
            if (i == 17) continue;  // half a second, but for rounding
            EXPECT_EQ(report.track.colour_rejected, hangs && i > 17) << i;
        }
    }
}

// An image that was refused is no better when it comes again.
TEST(Pipeline, ARepeatedImageIsAsWrongAsItWas) {
    Pipeline pipeline(SmallConfig(), SmallCamera());
    for (int i = 0; i < 14; ++i) {
        Frame frame = RoomFrame(i);
        if (i >= 10) {
            std::ranges::fill(std::span(frame.colour.data(), frame.colour.size()), Rgb8{3, 3, 3});
            frame.colour(0, 0) = {static_cast<std::uint8_t>(i / 2), 3, 3};
        }
        EXPECT_EQ(pipeline.Process(frame).track.colour_rejected, i >= 10) << i;
    }
}

// After a gap colours that do not fit may be those of another place: they are not called wrong.
TEST(Pipeline, AfterAGapColoursAreNotBlamed) {
    for (const double gap_s : {0.0, 0.8}) {
        Pipeline pipeline(SmallConfig(), SmallCamera());
        for (int i = 0; i < 10; ++i) pipeline.Process(RoomFrame(i));
        Frame dark = RoomFrame(10);
        dark.stamp_s += gap_s;
        std::ranges::fill(std::span(dark.colour.data(), dark.colour.size()), Rgb8{3, 3, 3});
        EXPECT_EQ(pipeline.Process(dark).track.colour_rejected, gap_s == 0);
    }
}

}  // namespace
}  // namespace tessera
