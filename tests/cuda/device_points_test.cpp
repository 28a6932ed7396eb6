#include "cuda/device_points.h"

#include <gtest/gtest.h>

#include <cstring>

#include "cuda/desk_frames.h"
#include "cuda/device_pipeline.h"

namespace tessera::host {
namespace {

using testing_support::DeskCamera;
using testing_support::DeskFrames;

FrameMotion Moving() {
    FrameMotion motion;
    motion.twist_per_s << 0.1, -0.2, 0.05, 0.2, 0.1, -0.1;
    motion.colour_delay_s = 0.01;
    motion.depth_readout_s = motion.colour_readout_s = 0.02;
    return motion;
}

bool Same(const std::vector<float>& values, const std::vector<float>& others) {
    return values.size() == others.size() &&
           (values.empty() || std::memcmp(values.data(), others.data(), 4 * values.size()) == 0);
}

void ExpectSame(const FramePoints& points, const FramePoints& expected) {
    EXPECT_EQ(points.valid(), expected.valid());
    ASSERT_EQ(points.width(), expected.width());
    ASSERT_EQ(points.height(), expected.height());
    EXPECT_EQ(points.ImageRow(3), expected.ImageRow(3));
    EXPECT_TRUE(Same(points.x, expected.x));
    EXPECT_TRUE(Same(points.y, expected.y));
    EXPECT_TRUE(Same(points.z, expected.z));
    EXPECT_TRUE(Same(points.weight, expected.weight));
    EXPECT_TRUE(Same(points.intensity, expected.intensity));
    EXPECT_TRUE(Same(points.cb, expected.cb));
    EXPECT_TRUE(Same(points.cr, expected.cr));
}

// Checks that SetPoints and TakePoints give the same points as FramePoints, without and with
// normals. Chroma is requested with intensities.
void ExpectSamePoints(DevicePipeline& device, const PreparedFrame& frame,
                      const PinholeCamera& camera, const FrameMotion& motion, int step,
                      const DepthWeight& weight, bool intensities) {
    const BlockMap map{BlockMap::Config()};
    PointArguments a =
        MakePointArguments(frame, camera, motion, step, weight, intensities, intensities);
    FramePoints expected, points;
    expected.Build(a);
    device.SetPoints(map, frame, a, points);
    device.TakePoints(points);
    ExpectSame(points, expected);

    a.normal_radius_px = 2;
    expected.Build(a);
    device.icp_sums().SetPoints(frame, a, 0, points);
    device.icp_sums().TakePoints(points);
    ExpectSame(points, expected);
}

TEST(DevicePoints, AreTheBytesOfFramePoints) {
    DevicePipeline device("host", std::size_t{1} << 30);
    std::size_t i = 0;
    for (const int step : {1, 2, 3, 8})
        for (const FrameMotion& motion : {FrameMotion(), Moving()})
            for (const double noise_depth_m : {0.0, 2.0})
                for (const bool intensities : {true, false}) {
                    SCOPED_TRACE(::testing::Message()
                                 << step << ", " << noise_depth_m << ", " << intensities);
                    ExpectSamePoints(device, DeskFrames()[i++ / 2 % DeskFrames().size()].prepared,
                                     DeskCamera(), motion, step,
                                     {noise_depth_m, intensities ? 0.5 : 1.5}, intensities);
                }
}

// Image sizes that no step divides, with slots outside the image. Later frames are larger or
// smaller than earlier ones, and some have no valid pixel.
TEST(DevicePoints, OfImagesOfAnySize) {
    DevicePipeline device("host", std::size_t{1} << 30);
    for (const auto& [width, height] : {std::pair(61, 47), std::pair(83, 31), std::pair(5, 4)}) {
        Frame frame;
        frame.depth_m = DepthImage(width, height);
        frame.colour = ColourImage(width, height);
        for (int v = 0; v < height; ++v)
            for (int u = 0; u < width; ++u) {
                frame.depth_m(u, v) =
                    (u * v) % 7 == 0 ? 0.0f : 1.0f + 0.01f * static_cast<float>(u + 2 * v);
                frame.colour(u, v) = {static_cast<std::uint8_t>(3 * u),
                                      static_cast<std::uint8_t>(5 * v), 77};
            }
        const PinholeCamera camera{width, height, 50, 51, 0.5 * width, 0.5 * height};
        PreparedFrame prepared;
        PrepareFrame(frame, {}, prepared);
        for (const int step : {1, 2, 5})
            ExpectSamePoints(device, prepared, camera, Moving(), step, {2.0}, true);
        frame.depth_m = DepthImage(width, height);
        PrepareFrame(frame, {}, prepared);  // reuses the same memory
        ExpectSamePoints(device, prepared, camera, Moving(), 2, {2.0}, true);
        frame.colour = {};
        PrepareFrame(frame, {}, prepared);
        // Intensities are requested although the frame has no colour.
        ExpectSamePoints(device, prepared, camera, Moving(), 2, {2.0}, true);
    }
}

TEST(DevicePoints, AreNoneWhereThereIsNoRoom) {
    const BlockMap map{BlockMap::Config()};
    const PreparedFrame& frame = DeskFrames()[0].prepared;
    const PointArguments a = MakePointArguments(frame, DeskCamera(), {}, 1, {2.0}, true);
    std::size_t none = 0, all = 0;
    for (std::size_t limit = std::size_t{10} << 20; limit < std::size_t{20} << 20;
         limit += std::size_t{1} << 16) {
        DevicePipeline device("host", limit);
        FramePoints slots;
        device.SetPoints(map, frame, a, slots);
        const std::int64_t valid = slots.valid();
        none += valid == 0;
        all += valid == frame.valid_depth_pixels;
        EXPECT_TRUE(valid == 0 || valid == frame.valid_depth_pixels) << valid;
        EXPECT_EQ(device.Sum({}, 0)[SumLayout::kKnown], 0);
    }
    EXPECT_GT(none, 0u);
    EXPECT_GT(all, 0u);
}

}  // namespace
}  // namespace tessera::host
