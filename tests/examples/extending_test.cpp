// The examples of docs/extending.md: a minimal tracker, source and detector, each called the way
// the program calls its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "io/selected_frames.h"
#include "semantics/detector.h"
#include "system/labelling_stage.h"
#include "tracking/tracker.h"

namespace tessera {
namespace {

// A tracker that follows the motion model.
class MotionModelTracker : public Tracker {
  public:
    TrackResult Track(const TrackInput& input) override {
        TrackResult result;
        result.T_world_camera = input.T_world_camera_starts.front();
        result.motion = input.motion;
        result.status = TrackStatus::kPoor;  // not to be fused, because nothing was measured
        result.reason = "the motion model only";
        return result;
    }
};

// A source that shows an approaching wall: from 2 m to 1 m in two seconds.
class NearingWall : public FrameSource {
  public:
    NearingWall() {
        info_.name = "nearing wall";
        info_.kind = "example";
        info_.camera = {.width = 64, .height = 48, .fx = 50, .fy = 50, .cx = 31.5, .cy = 23.5};
        info_.frame_count = 60;
        info_.fps = 30;
    }
    const SourceInfo& info() const override { return info_; }
    ReadResult Read(Frame& frame) override {
        if (next_ == info_.frame_count) return {ReadStatus::kEnd, {}};
        frame.index = next_++;
        frame.stamp_s = frame.colour_stamp_s = static_cast<double>(frame.index) / info_.fps;
        frame.depth_m.Resize(info_.camera.width, info_.camera.height);
        std::fill_n(frame.depth_m.data(), frame.depth_m.size(),
                    static_cast<float>(2 - frame.stamp_s / 2));
        frame.colour = ColourImage(info_.camera.width, info_.camera.height, Rgb8{90, 90, 90});
        frame.T_world_camera.reset();
        return {};
    }
    bool Seek(std::int64_t index) override {
        next_ = index;
        return index >= 0 && index <= info_.frame_count;
    }

  private:
    SourceInfo info_;
    std::int64_t next_ = 0;
};

// A detector that reports everything red as a cup.
class RedThings : public Detector {
  public:
    Result<std::vector<Detection>> Detect(const Frame& frame) override {
        Detection cup{"cup", 0, 0.9f, {1e9f, 1e9f, -1, -1}, {}};
        for (int y = 0; y < frame.colour.height(); ++y)
            for (int x = 0; x < frame.colour.width(); ++x) {
                const Rgb8 c = frame.colour(x, y);
                if (c.r < 150 || c.g > 60 || c.b > 60) continue;
                const auto u = static_cast<float>(x), v = static_cast<float>(y);
                cup.box = {std::min(cup.box.x_min, u), std::min(cup.box.y_min, v),
                           std::max(cup.box.x_max, u), std::max(cup.box.y_max, v)};
            }
        return cup.box.x_max < 0 ? std::vector<Detection>{} : std::vector<Detection>{cup};
    }
    bool needs_colour() const override { return true; }
    const std::vector<std::string>& class_names() const override { return names_; }

  private:
    std::vector<std::string> names_{"cup"};
};

TEST(Extending, ATrackerIsAskedOncePerFrame) {
    const PreparedFrame frame;
    const BlockMap map{BlockMap::Config{}};
    Eigen::Isometry3d expected = Eigen::Isometry3d::Identity();
    expected.translation().x() = 0.1;
    MotionModelTracker tracker;
    Tracker& used = tracker;
    const TrackResult result =
        used.Track({frame, map, {expected}, Eigen::Isometry3d::Identity(), 0, 1, {}});
    EXPECT_EQ(result.T_world_camera.translation().x(), 0.1);
    EXPECT_STREQ(ToString(result.status), ToString(TrackStatus::kPoor));
    EXPECT_FALSE(result.reason.empty());
}

TEST(Extending, ASourceIsReadAsAnyOther) {
    SelectedFrames frames(std::make_unique<NearingWall>(), {.start = 30, .count = 2, .stride = 15});
    Frame frame;
    ASSERT_EQ(frames.Next(frame).status, ReadStatus::kOk);
    EXPECT_FLOAT_EQ(frame.depth_m(10, 10), 1.5f);
    ASSERT_EQ(frames.Next(frame).status, ReadStatus::kOk);
    EXPECT_EQ(frame.index, 45);
    EXPECT_EQ(frames.Next(frame).status, ReadStatus::kEnd);
}

TEST(Extending, ADetectorAnswersTheLabellingStage) {
    LabelConfig config;
    config.classes = "cup";
    auto detector = std::make_unique<RedThings>();
    LabelClasses classes = LabelClasses::Make(config, detector->class_names()).value();
    LabellingStage stage(std::move(detector), std::move(classes), config,
                         {64, 48, 50, 50, 31.5, 23.5});
    Frame frame;
    frame.colour = ColourImage(64, 48, Rgb8{90, 90, 90});
    for (int x = 20; x <= 30; ++x) frame.colour(x, 12) = {200, 20, 20};
    LabelReport report;
    std::string message;
    ASSERT_TRUE(stage.Detect(frame, report, message)) << message;
    ASSERT_EQ(report.detections.size(), 1u);
    EXPECT_EQ(report.detections[0].box, (DetectionBox{20, 12, 30, 12}));
    EXPECT_GT(report.detections[0].class_id, 0);
    const ColourImage red = std::exchange(frame.colour, {});
    EXPECT_FALSE(stage.Detect(frame, report, message));
    EXPECT_EQ(message, "");
    frame.colour = red;
    EXPECT_TRUE(stage.Detect(frame, report, message));
}

}  // namespace
}  // namespace tessera
