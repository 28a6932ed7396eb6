#include "io/device_clock.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

using Verdict = DeviceClock::Verdict;

constexpr std::uint64_t kFrame_us = 33333;

TEST(DeviceClock, KeepsTheDevicesStamps) {
    DeviceClock clock(10);
    for (std::uint64_t i = 0; i < 5; ++i) {
        const auto reading = clock.Read(0, 5000000 + i * kFrame_us, 100 + static_cast<double>(i));
        EXPECT_EQ(reading.verdict, Verdict::kGood);
        EXPECT_DOUBLE_EQ(reading.stamp_s, 5 + 1e-6 * static_cast<double>(i * kFrame_us));
        // The other stream.
        EXPECT_EQ(clock.Read(1, 5000000 + i * kFrame_us, 100).verdict, Verdict::kGood);
    }
}

TEST(DeviceClock, RefusesSingleStampsThatMakeNoSense) {
    DeviceClock clock(10);
    EXPECT_EQ(clock.Read(0, 5000000, 0).verdict, Verdict::kGood);
    EXPECT_EQ(clock.Read(0, 5000000, 0).verdict, Verdict::kBackwards);
    EXPECT_EQ(clock.Read(0, 4000000, 0).verdict, Verdict::kBackwards);
    EXPECT_EQ(clock.Read(0, 15000001, 0).verdict, Verdict::kAbsurd);
    EXPECT_EQ(clock.Read(0, std::uint64_t{1} << 62, 0).verdict, Verdict::kAbsurd);
    EXPECT_EQ(clock.Read(0, 15000000, 0).verdict, Verdict::kGood);  // the largest accepted step
}

TEST(DeviceClock, ADeviceThatStartsAnewGoesOnInTime) {
    DeviceClock clock(10);
    clock.Read(0, 5000000, 100);
    clock.Restart();
    const auto first = clock.Read(0, 1000, 102.5);
    EXPECT_EQ(first.verdict, Verdict::kGood);
    EXPECT_NEAR(first.stamp_s, 7.5, 1e-9);
    EXPECT_NEAR(clock.Read(1, 1000 + kFrame_us, 102.5).stamp_s, 7.533333, 1e-9);
    clock.Restart();
    EXPECT_GT(clock.Read(1, 3, 102.5).stamp_s, 7.533333);  // at the same host time
}

TEST(DeviceClock, AClockThatWasSetIsFollowedAfterAFewStamps) {
    for (const std::uint64_t set_to : {std::uint64_t{1000}, std::uint64_t{900000000}}) {
        DeviceClock clock(10);
        double last_s = 0;
        for (std::uint64_t i = 0; i < 5; ++i)
            last_s = clock.Read(0, 50000000 + i * kFrame_us, 0.0333 * double(i)).stamp_s;
        int refused = 0;
        DeviceClock::Reading reading;
        do {
            reading = clock.Read(0, set_to + static_cast<std::uint64_t>(refused) * kFrame_us,
                                 0.2 + 0.0333 * refused);
        } while (reading.verdict != Verdict::kGood && ++refused < 20);
        EXPECT_EQ(refused, 3);
        EXPECT_TRUE(reading.was_reset);
        EXPECT_GT(reading.stamp_s, last_s);
        EXPECT_LT(reading.stamp_s, last_s + 1);
        EXPECT_EQ(clock.Read(0, set_to + 4 * kFrame_us, 1).verdict, Verdict::kGood);
    }
}

TEST(DeviceClock, AStuckClockIsNeverBelieved) {
    DeviceClock clock(10);
    clock.Read(0, 5000000, 0);
    for (int i = 0; i < 50; ++i) EXPECT_EQ(clock.Read(0, 5000000, i).verdict, Verdict::kBackwards);
}

}  // namespace
}  // namespace tessera
