// Objects that move in front of a wall, with exact depth images and a map of the wall.
#include "tracking/moving_detector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "tracking/moving_scene.h"

namespace tessera {
namespace moving_test {
namespace {

// 1 m/s, or 2.3 pixels per frame.
TEST_F(MovingDetectorTest, AWalkerIsMaskedWholeAndTheWallIsNot) {
    for (int i = 0; i < 10; ++i) See(View({}));
    for (int i = 0; i < 24; ++i) {
        const Box box = BoxAt(2.3 * i);
        const auto mask = See(View(box));
        ASSERT_NE(mask, nullptr) << i;
        int missed = 0, false_alarms = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const bool masked = mask->moving(mask->TileX(x), mask->TileY(y)) != 0;
                missed += box.Has(x, y) && !masked;
                false_alarms += !box.Has(x, y) && masked;
            }
        EXPECT_EQ(missed, 0) << i;
        EXPECT_LT(false_alarms, 5 * 2 * (35 + 80)) << i;  // a rim of neighbouring tiles
    }
}

// The person is there from the first frame on. What is behind has never been seen, and the map
// contains the person.
TEST_F(MovingDetectorTest, AWalkerOfTheFirstFrameIsFoundByWhereItWas) {
    wall_.box = BoxAt(0);
    std::shared_ptr<const MovingMask> mask;
    for (int i = 0; i < 24; ++i) mask = See(View(BoxAt(2.3 * i)));
    ASSERT_NE(mask, nullptr);
    const Box box = BoxAt(2.3 * 23);
    EXPECT_EQ(mask->moving((box.left + box.right) / 2, 50), 1);
    EXPECT_GT(mask->gone_tiles, 20 * 60);
    EXPECT_FLOAT_EQ(mask->gone_m(30, 50), kWall_m);  // where the person was
    EXPECT_EQ(mask->gone_m(120, 50), 0);             // where nobody was
}

// It is connected to wall that came into view just now. What the map had there before does not go
// with it; what is new to the map, or was in it for less than the window, could belong to it.
TEST_F(MovingDetectorTest, WhatTheMapHadBeforeDoesNotGoWithIt) {
    constexpr int kHidden = 30;
    const auto reveal = [&](int when) {
        const auto fill = [&] {
            for (int x = -30; x < 30; ++x)
                for (int y = -25; y < 25; ++y)
                    map_.Allocate({x, y, static_cast<int>(kWall_m / 0.08f)});
        };
        for (int i = 0; i < 60; ++i) {
            if (i == when) fill();
            DepthImage depth_m = View(i < 40 ? Box{} : Box{2 * i - 60, 2 * i - 25, 20, 90, 2.83f});
            HideRows(kHidden, depth_m);
            See(depth_m);
        }
        const auto mask = See(View({60, 95, 20, 90, 2.83f}));
        EXPECT_EQ(mask->moving(77, 25), 1);
        EXPECT_EQ(mask->moving(77, 60), 1);
        return mask->moving(77, 8) != 0;
    };
    EXPECT_TRUE(reveal(60));  // never
    detector_.Clear();
    EXPECT_TRUE(reveal(50));
    detector_.Clear();
    EXPECT_FALSE(reveal(60));  // filled before
}

// The background of the head is unknown, and the head is 15 cm behind the chest.
TEST_F(MovingDetectorTest, AHeadGoesWithItsBody) {
    constexpr int kUnknown = 30;
    wall_.unknown_rows = kUnknown;
    DepthImage wall_m = View({});
    HideRows(kUnknown, wall_m);
    for (int i = 0; i < 30; ++i) See(wall_m);
    for (int i = 0; i < 12; ++i) {
        const Box chest{20 + 2 * i, 55 + 2 * i, kUnknown, 90},
            head{30 + 2 * i, 45 + 2 * i, 15, kUnknown, kBox_m + 0.15f};
        DepthImage depth_m = View(chest);
        HideRows(kUnknown, depth_m);
        for (int y = head.top; y < head.bottom; ++y)
            std::fill(depth_m.row(y) + head.left, depth_m.row(y) + head.right, head.depth_m);
        const auto mask = See(depth_m);
        ASSERT_NE(mask, nullptr) << i;
        for (int y = head.top; y < head.bottom; ++y)
            for (int x = head.left; x < head.right; ++x)
                ASSERT_EQ(mask->moving(x, y), 1) << i << ": " << x << " " << y;
    }
}

// The map contains a box that was removed while it was out of view. The camera sees through it, but
// the detector queries the map only once someone else moves.
TEST_F(MovingDetectorTest, WhatWentUnseenIsGone) {
    wall_.box = BoxAt(0);
    for (int i = 0; i < 30; ++i) EXPECT_EQ(See(View({})), nullptr) << i;
    const auto mask = See(View(BoxAt(60)));
    ASSERT_NE(mask, nullptr);
    EXPECT_GT(mask->gone_tiles, 30 * 75);
    EXPECT_FLOAT_EQ(mask->gone_m(30, 50), kWall_m);
    EXPECT_EQ(mask->gone_m(65, 50), 0);
}

TEST_F(MovingDetectorTest, WhatADetectorSaysMovesHoweverStillItStands) {
    const Box box = BoxAt(30);
    DepthImage hinted_m(kWidth, kHeight, 0.0f);
    for (int y = box.top; y < box.bottom; ++y)
        std::fill(hinted_m.row(y) + box.left, hinted_m.row(y) + box.right, kBox_m);
    detector_.SetHint({hinted_m, stamp_s_ + kFrame_s}, 0,
                      std::nullopt);  // given for the first frame
    for (int i = 0; i < 25; ++i) {
        const auto expected = detector_.PredictMask(stamp_s_ + kFrame_s, T_world_camera_);
        const auto mask = See(View(box));
        ASSERT_NE(expected, nullptr) << i;
        ASSERT_NE(mask, nullptr) << i;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const bool near = x >= box.left - 4 && x < box.right + 4 && y >= box.top - 4 &&
                                  y < box.bottom + 4;
                ASSERT_GE(mask->moving(x, y), box.Has(x, y)) << i << ": " << x << " " << y;
                ASSERT_GE(expected->moving(x, y), box.Has(x, y)) << i << ": " << x << " " << y;
                ASSERT_LE(mask->moving(x, y), near) << i << ": " << x << " " << y;
            }
    }
    // A detection older than the window no longer counts. It does not count either where the depth
    // now differs.
    for (int i = 0; i < 10; ++i) See(View(box));
    EXPECT_EQ(See(View(box)), nullptr);
    detector_.SetHint({hinted_m, stamp_s_}, 0, T_world_camera_);
    EXPECT_EQ(detector_.Find({.depth_m = View({}),
                              .stamp_s = stamp_s_ + kFrame_s,
                              .T_world_camera = T_world_camera_},
                             map_, wall_),
              nullptr);
}

// Its frame was poor, so Find did not see it, and nobody knows where it belongs.
TEST_F(MovingDetectorTest, AHintOfAFrameThatWasNotTrackedIsForItAlone) {
    for (const bool tracked : {false, true}) {
        const double hinted_s = stamp_s_ + kFrame_s;
        detector_.SetHint({View(BoxAt(30)), hinted_s}, 0, std::nullopt);
        EXPECT_NE(detector_.PredictMask(hinted_s, T_world_camera_), nullptr);
        if (tracked)
            See(View({}));
        else
            stamp_s_ += kFrame_s;
        EXPECT_EQ(detector_.PredictMask(hinted_s + kFrame_s, T_world_camera_) != nullptr, tracked);
    }
}

// 5 % of the view, but at 0.4 m only 10 cm wide and high.
TEST_F(MovingDetectorTest, ANearHandIsMasked) {
    for (int i = 0; i < 10; ++i) See(View({}));
    for (int i = 0; i < 10; ++i) {
        const Box hand{20 + 4 * i, 46 + 4 * i, 30, 56, 0.4f};
        const auto mask = See(View(hand));
        ASSERT_NE(mask, nullptr) << i;
        EXPECT_EQ(mask->moving((hand.left + hand.right) / 2, 43), 1) << i;
    }
}

// The old object is smaller than three by three tiles. A person walks elsewhere.
TEST_F(MovingDetectorTest, ACrumbThatIsSeenThroughIsGone) {
    wall_.box = {100, 102, 40, 42};
    for (int i = 0; i < 30; ++i) See(View({}));
    const auto mask = See(View(BoxAt(0)));
    ASSERT_NE(mask, nullptr);
    EXPECT_EQ(mask->gone_tiles, 4);
    EXPECT_FLOAT_EQ(mask->gone_m(101, 41), kWall_m);
}

TEST_F(MovingDetectorTest, WhatMovedIsExpectedAgain) {
    for (int i = 0; i < 10; ++i) See(View({}));
    for (int i = 0; i < 10; ++i) See(View(BoxAt(2.3 * i)));
    const auto expected = detector_.PredictMask(stamp_s_ + kFrame_s, T_world_camera_);
    ASSERT_NE(expected, nullptr);
    const Box next = BoxAt(2.3 * 10);
    for (int y = next.top; y < next.bottom; ++y)
        for (int x = next.left; x < next.right; ++x)
            ASSERT_EQ(expected->moving(x, y), 1) << x << " " << y;
    EXPECT_EQ(detector_.PredictMask(stamp_s_ + 1, T_world_camera_), nullptr);
    detector_.Clear();
    EXPECT_EQ(detector_.PredictMask(stamp_s_ + kFrame_s, T_world_camera_), nullptr);
}

// Half as much again as the usual interval is waited for, but never less than 0.2 s, nor more than
// the window.
TEST_F(MovingDetectorTest, WhatMovedIsExpectedAgainByASlowCamera) {
    const std::pair<double, double> cases[] = {{0.1, 0.2}, {0.125, 0.2}, {0.25, 0.375}, {0.8, 1.0}};
    for (const auto& slow : cases) {
        const double interval_s = slow.first, longest_s = slow.second;
        detector_.Clear();
        const auto see = [&](const Box& box) {
            stamp_s_ += interval_s - kFrame_s;
            return See(View(box));
        };
        for (int i = 0; i < 12; ++i) see({});
        for (int i = 0; i < 3; ++i) ASSERT_NE(see(BoxAt(20 * i)), nullptr) << interval_s;
        EXPECT_NE(detector_.PredictMask(stamp_s_ + longest_s - 0.001, T_world_camera_), nullptr)
            << interval_s;
        EXPECT_EQ(detector_.PredictMask(stamp_s_ + longest_s + 0.001, T_world_camera_), nullptr)
            << interval_s;
    }
}

}  // namespace
}  // namespace moving_test
}  // namespace tessera
