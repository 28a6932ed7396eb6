#include "report/report_charts.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

FrameRow Frame(double stamp_s, FrameState state) {
    FrameRow row;
    row.stamp_s = stamp_s;
    row.state = state;
    row.frame_ms = 40;
    return row;
}

std::size_t Occurrences(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
    return count;
}

TEST(TrackingSection, EqualStatesAreOnePiece) {
    ReportData data;
    data.frames.emplace();
    for (int i = 0; i < 100; ++i)
        data.frames->rows.push_back(
            Frame(0.1 * i, i >= 40 && i < 50 ? FrameState::kLost : FrameState::kFused));
    const std::string html = TrackingSection(data);
    EXPECT_EQ(Occurrences(html, "<rect class=\"fused\""), 2u);
    EXPECT_EQ(Occurrences(html, "<rect class=\"lost\""), 1u);
    EXPECT_NE(html.find("<td>lost</td><td>10</td><td>10.0 %</td>"), std::string::npos) << html;
    EXPECT_NE(html.find("<td>4.00</td><td>10</td>"), std::string::npos) << html;
}

// Frame 70001 of 100000 is lost.
std::string HourWithALostFrame() {
    ReportData data;
    data.frames.emplace();
    for (int i = 0; i < 100000; ++i)
        data.frames->rows.push_back(
            Frame(i / 30.0, i == 70001 ? FrameState::kLost : FrameState::kFused));
    return TrackingSection(data);
}

TEST(TrackingSection, ASingleLostFrameOfAnHourIsSeen) {
    EXPECT_EQ(Occurrences(HourWithALostFrame(), "<rect class=\"lost\""), 1u);
}

// It is not the first of its 490th part of the time.
TEST(TrackingSection, ALostFrameColoursOnlyItsPlace) {
    const std::string html = HourWithALostFrame();
    for (const char* piece : {"<rect class=\"fused\" x=\"56.00\" y=\"26\" width=\"343.00\"",
                              "<rect class=\"lost\" x=\"399.00\" y=\"26\" width=\"1.00\"",
                              "<rect class=\"fused\" x=\"400.00\" y=\"26\" width=\"146.00\""})
        EXPECT_EQ(Occurrences(html, piece), 1u) << piece;
    EXPECT_EQ(Occurrences(html, "<rect class="), 3u);
}

TEST(TimesSection, SingleSlowFramesDoNotFlattenTheRest) {
    ReportData data;
    data.frames.emplace();
    for (int i = 0; i < 200; ++i) data.frames->rows.push_back(Frame(0.1 * i, FrameState::kFused));
    data.frames->rows[0].frame_ms = 4000;
    const std::string html = TimesSection(data);
    EXPECT_NE(html.find("1 of 200 frames took longer"), std::string::npos) << html;
    EXPECT_NE(html.find("<td>whole frame</td><td>40.0</td><td>59.8</td><td>40.0</td>"
                        "<td>4000.0</td>"),
              std::string::npos)
        << html;
}

TEST(Corrections, PairByStamp) {
    std::vector<StampedPose> before(3), after(3);
    for (int i = 0; i < 3; ++i) before[i].stamp_s = i;
    for (int i = 0; i < 3; ++i) after[i].stamp_s = i + 1;
    after[0].T_world_camera.translation().x() = 0.5;
    const auto corrections = CorrectionsOf(before, after);
    ASSERT_EQ(corrections.size(), 2u);
    EXPECT_DOUBLE_EQ(corrections[0].stamp_s, 1);
    EXPECT_DOUBLE_EQ(corrections[0].distance_m, 0.5);
    EXPECT_DOUBLE_EQ(corrections[1].distance_m, 0);
}

}  // namespace
}  // namespace tessera
