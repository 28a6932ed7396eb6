#include "viz/scan_hints.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

std::string TextFor(const ScanSigns& signs) {
    const auto hint = HintFor(signs);
    return hint ? hint->text : "";
}

ScanSigns Calm() {
    ScanSigns signs;
    signs.speed_m_s = 0.2;
    signs.turn_rad_s = 0.2;
    signs.depth = {.valid = 0.8, .too_far = 0, .median_m = 1.5};
    signs.frames = 200;
    return signs;
}

TEST(ScanHints, NoneIfAllIsWell) { EXPECT_EQ(TextFor(Calm()), ""); }

TEST(ScanHints, TheBlurIsThatOfTheExposure) {
    ScanSigns signs = Calm();
    signs.speed_m_s = 0.6;
    signs.turn_rad_s = 0.4;
    // 0.4 rad/s of its own and as much from the way at 1.5 m, during a sixtieth of a second.
    EXPECT_NEAR(Blur_px(signs), 525 * 0.8 / 60, 1e-9);
}

TEST(ScanHints, SlowerIfThePictureBlurs) {
    ScanSigns signs = Calm();
    signs.turn_rad_s = 1;
    EXPECT_EQ(TextFor(signs), "Move slower: the picture blurs");
    signs.turn_rad_s = 0.6;
    EXPECT_EQ(TextFor(signs), "");
    signs.speed_m_s = 0.9;
    EXPECT_EQ(TextFor(signs), "Move slower: the picture blurs");
}

TEST(ScanHints, CloserOrFartherByTheDepth) {
    ScanSigns signs = Calm();
    signs.depth = {.valid = 0.3, .too_far = 0.5, .median_m = 4};
    EXPECT_EQ(TextFor(signs), "Too far: go closer, or raise the largest depth");
    signs.depth = {.valid = 0.3, .too_far = 0, .median_m = 0.5};
    EXPECT_EQ(TextFor(signs), "Too close: step back");
    signs.depth = {.valid = 0, .too_far = 0, .median_m = 0};
    EXPECT_EQ(TextFor(signs).find("Little depth here"), 0u) << TextFor(signs);
}

TEST(ScanHints, TheMostUrgentWins) {
    ScanSigns signs = Calm();
    signs.thin_share = 0.8;
    EXPECT_EQ(HintFor(signs)->urgency, 1);
    signs.frames = 5;  // too early for that
    EXPECT_EQ(TextFor(signs), "");
    signs.degenerate = true;
    EXPECT_EQ(TextFor(signs).find("Little shape"), 0u);
    signs.status = TrackStatus::kPoor;
    EXPECT_EQ(TextFor(signs), "Tracking is poor: point back at where you were");
    signs.turn_rad_s = 2;
    EXPECT_EQ(TextFor(signs), "Move slower: the picture blurs");
    signs.status = TrackStatus::kLost;
    EXPECT_EQ(TextFor(signs).find("Lost: point the camera"), 0u);
}

TEST(ScanHints, TheDepthImageIsSharedOut) {
    DepthImage depth_m(64, 40, 0.0f);
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 64; ++x) depth_m(x, y) = x < 16 ? 0 : x < 32 ? 7.0f : 1.25f;
    const DepthShares shares = SharesOf(depth_m, 5);
    EXPECT_DOUBLE_EQ(shares.valid, 0.5);
    EXPECT_DOUBLE_EQ(shares.too_far, 0.25);
    EXPECT_DOUBLE_EQ(shares.median_m, 1.25);
    EXPECT_DOUBLE_EQ(SharesOf(DepthImage(64, 40, 0.0f), 5).valid, 0);
}

TEST(ScanHints, AreShownLongEnoughToBeRead) {
    HintHolder holder;
    const ScanHint slow{5, "slower"}, thin{1, "thin"};
    EXPECT_EQ(holder.Update(std::nullopt, 0), "");
    EXPECT_EQ(holder.Update(thin, 1), "thin");
    EXPECT_EQ(holder.Update(slow, 1.1), "slower");  // more urgent
    EXPECT_EQ(holder.Update(thin, 1.2), "slower");  // less
    EXPECT_EQ(holder.Update(std::nullopt, 2.5), "slower");
    EXPECT_EQ(holder.Update(slow, 2.55), "slower");  // again: the time starts anew
    EXPECT_EQ(holder.Update(std::nullopt, 4.0), "slower");
    EXPECT_EQ(holder.Update(std::nullopt, 4.1), "");
}

}  // namespace
}  // namespace tessera
