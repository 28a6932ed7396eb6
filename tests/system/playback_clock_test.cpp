// At which times the frames of a recording are passed on, by a clock that stands still meanwhile.
#include "system/playback_clock.h"

#include <gtest/gtest.h>

#include <vector>

namespace tessera {
namespace {

// Waits as it is told, and returns for how long.
std::vector<double> Waits(double speed, const std::vector<double>& stamps_s) {
    PlaybackClock clock(speed);
    std::vector<double> waits;
    double now_s = 500;
    for (const double stamp_s : stamps_s) {
        waits.push_back(clock.Wait_s(stamp_s, now_s));
        now_s += waits.back();
    }
    return waits;
}

using List = std::vector<double>;

TEST(PlaybackClock, KeepsTheRecordingsPace) {
    EXPECT_EQ(Waits(1, {10, 10.25, 10.5, 11.5}), (List{0, 0.25, 0.25, 1}));
    EXPECT_EQ(Waits(2, {10, 10.25, 10.5, 11.5}), (List{0, 0.125, 0.125, 0.5}));
}

// A frame is then due many seconds after the last.
TEST(PlaybackClock, PlaysAsSlowlyAsItIsTold) {
    EXPECT_EQ(Waits(0.015625, {0, 0.25, 0.5}), (List{0, 16, 16}));
}

TEST(PlaybackClock, WaitsForFramesThatAreFarApart) {
    EXPECT_EQ(Waits(1, {0, 3, 6, 9}), (List{0, 0, 3, 3}));
}

TEST(PlaybackClock, DoesNotWaitForAPause) {
    EXPECT_EQ(Waits(1, {0, 0.25, 60, 60.25}), (List{0, 0.25, 0, 0.25}));
    EXPECT_EQ(Waits(0.0625, {0, 0.25, 60, 60.25}), (List{0, 4, 0, 4}));
    EXPECT_EQ(Waits(1, {60, 60.25, 0, 0.25}), (List{0, 0.25, 0, 0.25}));  // or a clock set back
}

TEST(PlaybackClock, ALateReaderCatchesUpByUpToASecond) {
    PlaybackClock clock(1);
    clock.Wait_s(0, 100);
    EXPECT_EQ(clock.Wait_s(0.25, 101), 0);
    EXPECT_EQ(clock.Wait_s(0.5, 101), 0);
    EXPECT_EQ(clock.Wait_s(1.25, 101), 0.25);
    EXPECT_EQ(clock.Wait_s(1.5, 103), 0);
    EXPECT_EQ(clock.Wait_s(1.75, 103), 0.25) << "it was too late";
    clock.Restart();
    EXPECT_EQ(clock.Wait_s(2, 103), 0);
    EXPECT_EQ(clock.Wait_s(2.25, 103), 0.25);
}

}  // namespace
}  // namespace tessera
