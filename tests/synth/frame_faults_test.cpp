#include "synth/frame_faults.h"

#include <gtest/gtest.h>

#include <map>

namespace tessera {
namespace {

constexpr PinholeCamera kFaultCamera{64, 48, 60, 60, 31.5, 23.5};

Frame GoodFrame(std::int64_t index = 100) {
    Frame frame;
    frame.index = index;
    frame.stamp_s = frame.colour_stamp_s = 1000 + static_cast<double>(index) / 30;
    frame.depth_m.Resize(kFaultCamera.width, kFaultCamera.height);
    frame.colour.Resize(kFaultCamera.width, kFaultCamera.height);
    for (int y = 0; y < kFaultCamera.height; ++y)
        for (int x = 0; x < kFaultCamera.width; ++x) {
            frame.depth_m(x, y) = 1 + 0.01f * static_cast<float>(x + y);
            frame.colour(x, y) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(2 * y),
                                  9};
        }
    return frame;
}

Frame Faulty(FrameFault fault) {
    Frame frame = GoodFrame();
    ApplyFault(fault, kFaultCamera, 5, frame);
    return frame;
}

TEST(FrameFaults, TheShareIsAsAskedAndTheFirstSecondIsGood) {
    const FrameFaults faults({.share = 0.2, .in_a_row = 3}, kFaultCamera, 1);
    std::map<FrameFault, int> seen;
    int count = 0;
    for (std::int64_t i = 0; i < 30030; ++i) {
        const auto fault = faults.Of(i);
        ASSERT_FALSE(i < 30 && fault);
        if (i >= 30 && (i - 30) % 3 != 0) {
            ASSERT_EQ(fault, faults.Of(i - 1)) << i;
        }
        count += fault.has_value();
        if (fault) ++seen[*fault];
    }
    EXPECT_NEAR(count, 6000, 300);
    EXPECT_EQ(std::ssize(seen), kFrameFaults);
    const FrameFaults none({}, kFaultCamera, 1);
    for (std::int64_t i = 0; i < 1000; ++i) ASSERT_FALSE(none.Of(i));
}

TEST(FrameFaults, EachIsWhatItSays) {
    const Frame good = GoodFrame();
    EXPECT_FLOAT_EQ(Faulty(FrameFault::kNear).depth_m(5, 5), 0.11f);
    EXPECT_FLOAT_EQ(Faulty(FrameFault::kFar).depth_m(5, 5), 11.0f);
    EXPECT_EQ(Faulty(FrameFault::kBlack).depth_m(5, 5), 0);
    EXPECT_EQ(Faulty(FrameFault::kSaturated).colour(5, 5), (Rgb8{255, 255, 255}));
    EXPECT_EQ(Faulty(FrameFault::kStripes).depth_m(5, 8), 0);
    EXPECT_EQ(Faulty(FrameFault::kStripes).depth_m(5, 7), good.depth_m(5, 7));
    EXPECT_EQ(Faulty(FrameFault::kBlocks).depth_m(5, 20), good.depth_m(21, 32));
    EXPECT_EQ(Faulty(FrameFault::kBlocks).depth_m(5, 5), good.depth_m(5, 5));
    EXPECT_DOUBLE_EQ(Faulty(FrameFault::kOutOfOrder).stamp_s, good.stamp_s - 0.5);
    EXPECT_FLOAT_EQ(Faulty(FrameFault::kSwapped).depth_m(5, 20), 0.8f);
    EXPECT_EQ(Faulty(FrameFault::kSwapped).colour(5, 20).r, 62);
    EXPECT_EQ(Faulty(FrameFault::kZoomed).depth_m(61, 23), good.depth_m(51, 23));
    EXPECT_EQ(Faulty(FrameFault::kZoomed).depth_m(31, 23), good.depth_m(31, 23));
    const Frame bits = Faulty(FrameFault::kBits);
    int depths = 0, colours = 0;
    for (std::size_t i = 0; i < good.depth_m.size(); ++i) {
        depths += std::abs(bits.depth_m.data()[i] - good.depth_m.data()[i]) > 1e-3f;
        colours += bits.colour.data()[i].g != good.colour.data()[i].g;
    }
    EXPECT_NEAR(depths, 0.016 * 64 * 48, 25);
    EXPECT_NEAR(colours, 0.008 * 64 * 48, 20);
}

TEST(FrameFaults, ARepeatedFrameShowsTheLastGoodOne) {
    const FrameFaults::Config config{.share = 0.5, .in_a_row = 1};
    FrameFaults faults(config, kFaultCamera, 3);
    Frame before = GoodFrame(0);
    int repeated = 0;
    for (std::int64_t i = 0; i < 300; ++i) {
        Frame frame = GoodFrame(i);
        frame.depth_m(0, 0) = static_cast<float>(i);
        const auto fault = faults.Of(i);
        faults.Apply(frame);
        if (!fault) before = frame;
        if (fault != FrameFault::kRepeated) continue;
        ++repeated;
        EXPECT_EQ(frame.depth_m(0, 0), before.depth_m(0, 0));
        EXPECT_EQ(frame.index, i);
    }
    EXPECT_GT(repeated, 3);
}

// As after a seek.
TEST(FrameFaults, WithoutAFrameBeforeNothingIsRepeated) {
    FrameFaults faults({.share = 0.5, .in_a_row = 1}, kFaultCamera, 3);
    std::int64_t first = 30;
    while (faults.Of(first) != FrameFault::kRepeated) ++first;
    Frame frame = GoodFrame(first);
    faults.Apply(frame);
    EXPECT_EQ(frame.depth_m, GoodFrame(first).depth_m);
    EXPECT_EQ(frame.colour, GoodFrame(first).colour);
}

}  // namespace
}  // namespace tessera
