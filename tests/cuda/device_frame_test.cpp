#include "cuda/device_frame.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "cuda/desk_frames.h"
#include "cuda/device_pipeline.h"

namespace tessera::host {
namespace {

using testing_support::DeskFrames;

template <class T>
void ExpectSameImage(const Image<T>& image, const Image<T>& expected) {
    ASSERT_EQ(image.width(), expected.width());
    ASSERT_EQ(image.height(), expected.height());
    if (expected.empty()) return;
    EXPECT_EQ(std::memcmp(image.data(), expected.data(), expected.size() * sizeof(T)), 0);
}

void ExpectSameReduced(const PreparedFrame& frame, const PreparedFrame& expected) {
    EXPECT_EQ(frame.width, expected.width);
    EXPECT_EQ(frame.height, expected.height);
    EXPECT_EQ(frame.has_colour, expected.has_colour);
    EXPECT_EQ(frame.valid_depth_pixels, expected.valid_depth_pixels);
    EXPECT_EQ(frame.measured_pixels, expected.measured_pixels);
    EXPECT_EQ(frame.coherent_fraction, expected.coherent_fraction);
    EXPECT_EQ(frame.nearest_m, expected.nearest_m);
    EXPECT_EQ(frame.farthest_m, expected.farthest_m);
    for (std::size_t i = 0; i < expected.reduced.size(); ++i) {
        ExpectSameImage(frame.reduced[i].intensity, expected.reduced[i].intensity);
        ExpectSameImage(frame.reduced[i].depth_m, expected.reduced[i].depth_m);
    }
}

void ExpectSameFrame(const PreparedFrame& frame, const PreparedFrame& expected) {
    ExpectSameReduced(frame, expected);
    ExpectSameImage(frame.depth_m, expected.depth_m);
    ExpectSameImage(frame.intensity, expected.intensity);
    ExpectSameImage(frame.packed_colour, expected.packed_colour);
}

// Depths of every kind, in range and out of range, and random colours.
Frame AnyFrame(int width, int height, bool colour, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> depth(0.1f, 6.0f);
    Frame frame;
    frame.depth_m.Resize(width, height);
    frame.colour.Resize(colour ? width : 0, colour ? height : 0);
    for (std::size_t i = 0; i < frame.depth_m.size(); ++i) {
        const std::uint32_t kind = random() % 16;
        const float before = i > 0 ? frame.depth_m.data()[i - 1] : 1.0f;
        frame.depth_m.data()[i] = kind == 0   ? 0.0f
                                  : kind == 1 ? std::numeric_limits<float>::quiet_NaN()
                                  : kind == 2 ? -1.0f
                                  : kind < 10 ? before * 1.02f
                                              : depth(random);
        if (colour)
            frame.colour.data()[i] = {static_cast<std::uint8_t>(random()),
                                      static_cast<std::uint8_t>(random()),
                                      static_cast<std::uint8_t>(random())};
    }
    return frame;
}

TEST(DeviceFrame, IsTheBytesOfThePreparedFrame) {
    DevicePipeline device("host", std::size_t{1} << 30);
    PreparedFrame made, expected;
    std::uint32_t seed = 0;
    for (const auto& [width, height] :
         {std::pair(160, 120), std::pair(641, 37), std::pair(64, 48), std::pair(16, 16)})
        for (const bool colour : {true, false})
            for (int blur = 0; blur <= 4; ++blur) {
                SCOPED_TRACE(::testing::Message()
                             << width << " x " << height << ", " << colour << ", " << blur);
                const Frame frame = AnyFrame(width, height, colour, ++seed);
                PreparedFrame::Config config;
                config.intensity_blur_px = blur;
                config.disparity_offset_per_m = blur % 2 == 0 ? 0.0 : 0.003;
                PrepareFrame(frame, config, expected);
                ASSERT_GT(expected.valid_depth_pixels, 10);
                device.Prepare(frame, config, nullptr, true, made);
                ExpectSameFrame(made, expected);
                EXPECT_NE(made.identity, expected.identity);
                device.Prepare(frame, config, nullptr, false, made);
                ExpectSameReduced(made, expected);
                EXPECT_TRUE(made.depth_m.empty() && made.intensity.empty() &&
                            made.packed_colour.empty());
            }
    Frame none;
    none.depth_m = DepthImage(32, 24, 0.0f);
    PrepareFrame(none, {}, expected);
    device.Prepare(none, {}, nullptr, true, made);
    ExpectSameFrame(made, expected);
}

// A frame prepared on the device is not uploaded for fusion and tracking, and no frame is uploaded
// twice. A frame prepared elsewhere is uploaded.
TEST(DeviceFrame, IsThereWhenItWasMadeThere) {
    DeviceMemory memory(std::size_t{1} << 30);
    Stream stream;
    DeviceFrame on_device(memory, stream);
    PreparedFrame made;
    ASSERT_TRUE(on_device.Prepare(DeskFrames()[0].frame, {}, false, made));
    ASSERT_TRUE(on_device.Upload(made));
    const PreparedFrame& expected = DeskFrames()[0].prepared;
    EXPECT_EQ(
        std::memcmp(on_device.depth_m(), expected.depth_m.data(), 4 * expected.depth_m.size()), 0);
    EXPECT_EQ(std::memcmp(on_device.intensity(), expected.intensity.data(),
                          4 * expected.intensity.size()),
              0);
    EXPECT_EQ(std::memcmp(on_device.packed_colour(), expected.packed_colour.data(),
                          4 * expected.packed_colour.size()),
              0);

    const PreparedFrame& other = DeskFrames()[7].prepared;
    ASSERT_TRUE(on_device.Upload(other));
    stream.Wait();
    EXPECT_EQ(std::memcmp(on_device.depth_m(), other.depth_m.data(), 4 * other.depth_m.size()), 0);
    EXPECT_FALSE(on_device.Upload(made)) << "its images are no longer on the device";
    EXPECT_FALSE(on_device.Upload(PreparedFrame())) << "no frame";
}

// When device memory is short, the CPU prepares the frame.
TEST(DeviceFrame, IsMadeByTheProcessorWhereThereIsNoRoom) {
    DevicePipeline device("host", std::size_t{64} << 10);
    PreparedFrame made;
    device.Prepare(DeskFrames()[3].frame, {}, nullptr, false, made);
    ExpectSameFrame(made, DeskFrames()[3].prepared);
}

}  // namespace
}  // namespace tessera::host
