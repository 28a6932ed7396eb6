#include "viz/quality.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

FrameUpdate GoodFrame() {
    FrameUpdate frame;
    frame.report.index = 40;
    frame.report.track.status = TrackStatus::kGood;
    frame.report.fused = true;
    frame.counts.frames = frame.counts.tracked = 100;
    return frame;
}

class QualityTest : public testing::Test {
  protected:
    Quality Now() const { return QualityOf(signs); }
    FrameUpdate frame = GoodFrame();
    QualitySigns signs{.frame = &frame, .recent = {.frames = 60, .tracked = 60}};
};

TEST_F(QualityTest, IsGreenIfAllIsWell) {
    EXPECT_EQ(Now().level, QualityLevel::kGood);
    frame.report.first = true;
    EXPECT_EQ(Now().level, QualityLevel::kGood);
    EXPECT_EQ(Now().title, "Started");
    frame.report.begins_part = true;  // the map goes on
    EXPECT_EQ(Now().level, QualityLevel::kGood);
    EXPECT_EQ(Now().title, "A new part");
    EXPECT_EQ(QualityOf({}).title, "Waiting");
}

TEST_F(QualityTest, IsAmberIfMoreThanATenthWasDroppedLately) {
    signs.recent.dropped = 6;
    EXPECT_EQ(Now().level, QualityLevel::kGood);
    signs.recent.dropped = 7;
    EXPECT_EQ(Now().level, QualityLevel::kWarning);
    EXPECT_EQ(Now().title, "Dropping frames");
    EXPECT_NE(Now().reason.find("12 %"), std::string::npos) << Now().reason;
}

TEST_F(QualityTest, IsAmberForEachOtherTrouble) {
    const auto expect = [&](const char* title, auto spoil) {
        QualityTest::signs = {.frame = &frame, .recent = {.frames = 60}};
        frame = GoodFrame();
        spoil();
        EXPECT_EQ(Now().level, QualityLevel::kWarning) << title;
        EXPECT_EQ(Now().title, title);
        EXPECT_FALSE(Now().reason.empty()) << title;
    };
    expect("Unsure", [&] { frame.report.track.degenerate = true; });
    expect("Tracking only", [&] { signs.fusing = false; });
    expect("Map is behind", [&] { signs.recent.unfused = 7; });
    expect("Labelling has failed", [&] { signs.detector_failed = true; });
    expect("Poor, not added to the map", [&] {
        frame.report.track.status = TrackStatus::kPoor;
        frame.report.track.reason = "few inliers";
    });
}

TEST_F(QualityTest, IsRedIfLostAndGreyIfNothingComes) {
    frame.report.track.status = TrackStatus::kLost;
    frame.report.track.reason = "no overlap";
    EXPECT_EQ(Now().level, QualityLevel::kBad);
    EXPECT_EQ(Now().reason, "no overlap");
    signs.silent_s = 4;
    EXPECT_EQ(Now().level, QualityLevel::kIdle);
    EXPECT_NE(Now().reason.find("4 s"), std::string::npos) << Now().reason;
    signs.silent_s = 0;
    signs.paused = true;
    EXPECT_EQ(Now().title, "Paused");
}

TEST_F(QualityTest, TellsOfTheWholeRunAtItsEnd) {
    signs.ended = true;
    EXPECT_EQ(Now().level, QualityLevel::kIdle);
    EXPECT_EQ(Now().reason, "100 of 100 frames tracked");
    frame.counts.frames = 388;
    frame.counts.dropped = 288;
    EXPECT_EQ(Now().level, QualityLevel::kWarning);
    EXPECT_NE(Now().reason.find("288 dropped"), std::string::npos) << Now().reason;
}

}  // namespace
}  // namespace tessera
