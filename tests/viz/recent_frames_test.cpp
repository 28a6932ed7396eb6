#include "viz/recent_frames.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

constexpr double kPeriod_s = 1.0 / 30;

FrameUpdate UpdateAt(int i) {
    FrameUpdate update;
    update.report.stamp_s = kPeriod_s * i;
    update.report.first = i == 0;
    update.report.track.status = TrackStatus::kGood;
    update.counts.frames = i + 1;
    return update;
}

TEST(RecentFrames, CountsThoseOfTheLastTwoSeconds) {
    RecentFrames recent;
    EXPECT_EQ(recent.counts().frames, 0);
    for (int i = 0; i < 300; ++i) {
        FrameUpdate update = UpdateAt(i);
        update.counts.dropped = std::min(i, 200);  // one a frame, and none at the end
        recent.Add(update, kPeriod_s * i);
    }
    EXPECT_NEAR(static_cast<double>(recent.counts().frames), 60, 1);
    EXPECT_EQ(recent.counts().dropped, 0);
    EXPECT_NEAR(recent.SilentFor_s(kPeriod_s * 299 + 4), 4, 1e-9);
    FrameUpdate part = UpdateAt(300);  // a new part of the scan: the counts go on
    part.report.first = part.report.begins_part = true;
    part.counts.dropped = 200;
    recent.Add(part, kPeriod_s * 300);
    EXPECT_NEAR(static_cast<double>(recent.counts().frames), 60, 1);
    EXPECT_EQ(recent.counts().dropped, 0);
    recent.Add(UpdateAt(0), 20);  // after a reset
    EXPECT_EQ(recent.counts().frames, 1);
}

TEST(RecentFrames, MeasuresHowFastTheCameraMoves) {
    RecentFrames recent;
    const auto add = [&](int i) {
        FrameUpdate update = UpdateAt(i);
        Eigen::Isometry3d& T = update.report.track.T_world_camera;
        T.translation() = Eigen::Vector3d(0.02 * i, 0, 0);
        T.linear() = Eigen::AngleAxisd(0.01 * i, Eigen::Vector3d::UnitY()).toRotationMatrix();
        recent.Add(update, kPeriod_s * i);
    };
    add(0);
    EXPECT_EQ(recent.speed_m_s(), 0);
    for (int i = 1; i < 30; ++i) add(i);
    EXPECT_NEAR(recent.speed_m_s(), 0.6, 1e-6);
    EXPECT_NEAR(recent.turn_rad_s(), 0.3, 1e-6);
    FrameUpdate lost = UpdateAt(30);
    lost.report.track.status = TrackStatus::kLost;
    recent.Add(lost, 1);
    EXPECT_EQ(recent.speed_m_s(), 0);
    add(40);  // found elsewhere: no speed from a jump
    EXPECT_EQ(recent.speed_m_s(), 0);
}

}  // namespace
}  // namespace tessera
