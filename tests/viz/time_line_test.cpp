#include "viz/time_line.h"

#include <gtest/gtest.h>

#include "io/file.h"
#include "io/trajectory.h"
#include "report/made_up_run.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

class TimeLineFiles : public testing::Test {
  protected:
    void WritePath(const std::vector<double>& stamps_s) {
        std::vector<StampedPose> path;
        for (const double stamp_s : stamps_s) {
            StampedPose& pose = path.emplace_back();
            pose.stamp_s = stamp_s;
            pose.T_world_camera.translation().x() = stamp_s;
        }
        ASSERT_TRUE(WriteTrajectory(folder_ / "trajectory.txt", path).ok());
    }
    void WriteFrames(const std::string& lines) {
        ASSERT_TRUE(WriteTextFile(folder_ / "frames.csv", kFramesHeader + lines).ok());
    }
    std::vector<bool> Posed() const {
        std::vector<bool> posed;
        const TimeLine line = ReadTimeLine(folder_.path()).value();
        for (const TimeLineFrame& frame : line.frames)
            posed.push_back(frame.T_world_camera.has_value());
        return posed;
    }
    TempFolder folder_;
};

// The made-up run is lost in frame 12; its trajectory has a pose at every stamp.
TEST_F(TimeLineFiles, FramesHaveTheirPosesAndFigures) {
    WriteMadeUpRun(folder_.path(), "made up");
    const auto line = ReadTimeLine(folder_.path());
    ASSERT_TRUE(line);
    ASSERT_EQ(line->frames.size(), 30u);
    EXPECT_TRUE(line->has_figures);
    EXPECT_EQ(line->frames[12].row.state, FrameState::kLost);
    EXPECT_EQ(line->frames[4].row.index, 4);
    EXPECT_DOUBLE_EQ(line->frames[4].row.track_ms, 20.5);
    EXPECT_NEAR(line->frames[4].at_s, 0.4, 1e-6);
    ASSERT_TRUE(line->frames[7].T_world_camera);
    EXPECT_NEAR(line->frames[7].T_world_camera->translation().x(), 0.35, 1e-6);
    ASSERT_TRUE(line->run.camera);
    EXPECT_EQ(line->run.camera->width, 640);
    EXPECT_EQ(line->run.source_name, "made up");
    ASSERT_FALSE(line->run.configuration.empty());
}

TEST_F(TimeLineFiles, LostFramesHaveNoPose) {
    WritePath({100.0, 100.1, 100.3});
    WriteFrames(FrameLine(0, "good", 1, "") + FrameLine(1, "poor", 0, "") +
                FrameLine(2, "lost", 0, "dark") + FrameLine(3, "good", 1, ""));
    EXPECT_EQ(Posed(), (std::vector{true, true, false, true}));
    Replay replay(*ReadTimeLine(folder_.path()));
    replay.GoTo(2);
    EXPECT_NEAR(replay.T_world_camera().translation().x(), 100.1, 1e-6);  // stays where it was
}

TEST_F(TimeLineFiles, WithoutFramesThePosesAreTheFrames) {
    WritePath({5, 5.5, 6});
    const auto line = ReadTimeLine(folder_.path());
    ASSERT_TRUE(line);
    EXPECT_EQ(line->frames.size(), 3u);
    EXPECT_FALSE(line->has_figures);
    EXPECT_FALSE(line->run.camera);
    EXPECT_DOUBLE_EQ(line->frames[2].at_s, 1);
    EXPECT_EQ(line->frames[2].row.index, 2);
}

// Two recordings in one scan: the clock starts again, and the poses are in two files.
TEST_F(TimeLineFiles, EachClockHasItsOwnPoses) {
    std::vector<StampedPose> path(4);
    for (std::size_t i = 0; i < 4; ++i) {
        path[i].stamp_s = i < 2 ? 100 + 0.1 * static_cast<double>(i + 2)
                                : 100 + 0.1 * static_cast<double>(i - 2) - 50;
        path[i].T_world_camera.translation().x() = static_cast<double>(i);
    }
    ASSERT_TRUE(WriteTrajectory(folder_ / "trajectory.txt", path).ok());
    std::string second = FrameLine(0, "good", 1, "") + FrameLine(1, "good", 1, "");
    for (std::size_t at = 0; (at = second.find(",100.", at)) != std::string::npos;)
        second.replace(at, 5, ",50.");
    WriteFrames(FrameLine(2, "good", 1, "") + FrameLine(3, "good", 1, "") + second);
    const auto line = ReadTimeLine(folder_.path());
    ASSERT_TRUE(line);
    for (std::size_t i = 0; i < 4; ++i) {
        ASSERT_TRUE(line->frames.at(i).T_world_camera) << i;
        EXPECT_EQ(line->frames[i].T_world_camera->translation().x(), static_cast<double>(i));
    }
    EXPECT_GE(line->frames[2].at_s, line->frames[1].at_s);
}

TEST_F(TimeLineFiles, DamageIsTolerated) {
    EXPECT_FALSE(ReadTimeLine(folder_.path()));
    WritePath({1});
    EXPECT_FALSE(ReadTimeLine(folder_.path()));  // nothing to scrub through
    WritePath({1, 2});
    ASSERT_TRUE(WriteTextFile(folder_ / "frames.csv", "\xff\xfe,,,").ok());
    ASSERT_TRUE(WriteTextFile(folder_ / "run.json", "{\"source\": 3}").ok());
    const auto line = ReadTimeLine(folder_.path());
    ASSERT_TRUE(line);
    EXPECT_EQ(line->frames.size(), 2u);
    // Frames of another run: none has a pose.
    WriteFrames(FrameLine(0, "good", 1, "") + FrameLine(1, "good", 1, ""));
    const auto other = ReadTimeLine(folder_.path());
    EXPECT_FALSE(other->has_figures);
    EXPECT_TRUE(other->frames[0].T_world_camera);
}

class ReplayOfARun : public testing::Test {
  protected:
    static Replay Make() {
        TimeLine line;
        for (const double at_s : {0.0, 0.1, 0.2, 1.2}) line.frames.emplace_back().at_s = at_s;
        return Replay(std::move(line));
    }
};

TEST_F(ReplayOfARun, StepsStayOnTheLine) {
    Replay replay = Make();
    replay.Step(-1);
    EXPECT_EQ(replay.position(), 0u);
    replay.Step(2);
    EXPECT_EQ(replay.position(), 2u);
    replay.Step(10);
    EXPECT_EQ(replay.position(), 3u);
    replay.GoTo(99);
    EXPECT_EQ(replay.position(), replay.last());
}

TEST_F(ReplayOfARun, PlaysAtTheRecordedRate) {
    Replay replay = Make();
    EXPECT_FALSE(replay.Advance(10));  // does not play yet
    replay.TogglePlaying();
    EXPECT_FALSE(replay.Advance(0.05));
    EXPECT_TRUE(replay.Advance(0.06));
    EXPECT_EQ(replay.position(), 1u);
    EXPECT_TRUE(replay.Advance(0.5));
    EXPECT_EQ(replay.position(), 2u);
    EXPECT_TRUE(replay.Advance(0.7));
    EXPECT_EQ(replay.position(), 3u);
    EXPECT_FALSE(replay.playing());  // the end
    replay.TogglePlaying();          // again from the beginning
    EXPECT_EQ(replay.position(), 0u);
    EXPECT_TRUE(replay.playing());
    replay.Step(1);
    EXPECT_FALSE(replay.playing());  // by hand
}

}  // namespace
}  // namespace tessera
