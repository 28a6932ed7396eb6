// Labelling where some frames, or all, have no colour image.
#include <chrono>
#include <future>
#include <utility>
#include <vector>

#include "system/engine_fixture.h"
#include "system/frame_labelling.h"
#include "system/live_mapping.h"
#include "system/room_frames.h"

namespace tessera {
namespace {

// Looks at colour, and would fail without it.
class ColourDetector : public Detector {
  public:
    explicit ColourDetector(std::promise<void>* looked = nullptr) : looked_(looked) {}
    Result<std::vector<Detection>> Detect(const Frame& frame) override {
        if (frame.colour.empty()) return Status::Error("it was called without colour");
        if (std::promise<void>* looked = std::exchange(looked_, nullptr)) looked->set_value();
        return std::vector<Detection>{};
    }
    bool needs_colour() const override { return true; }
    const std::vector<std::string>& class_names() const override { return names_; }

  private:
    std::promise<void>* looked_;
    std::vector<std::string> names_{"cup"};
};

Labelling CupsInColour(std::promise<void>* looked = nullptr) {
    LabelConfig config;
    config.classes = "cup";
    auto detector = std::make_unique<ColourDetector>(looked);
    LabelClasses classes = LabelClasses::Make(config, detector->class_names()).value();
    return {std::move(detector), std::move(classes)};
}

LabellingStage StageInColour() {
    Labelling labelling = CupsInColour();
    return {std::move(labelling.detector), std::move(labelling.classes), {}, {}};
}

Frame Coloured() {
    Frame frame;
    frame.colour = ColourImage(4, 3, Rgb8{90, 90, 90});
    return frame;
}

TEST(ColourlessLabelling, SuchFramesArePassedOver) {
    LabellingStage stage = StageInColour();
    LabelReport report;
    std::string message;
    for (int i = 0; i < 29; ++i) EXPECT_FALSE(stage.Detect({}, report, message));
    EXPECT_TRUE(stage.Detect(Coloured(), report, message));
    for (int i = 0; i < 100; ++i) {
        EXPECT_FALSE(stage.Detect({}, report, message));
        EXPECT_EQ(message, "") << i;
    }
    EXPECT_TRUE(stage.Detect(Coloured(), report, message));
    EXPECT_FALSE(stage.broken());
}

TEST(ColourlessLabelling, IfThereIsNoColourAtAllThatIsSaidOnce) {
    LabellingStage stage = StageInColour();
    LabelReport report;
    std::string message;
    for (int i = 1; i <= 40; ++i) {
        EXPECT_FALSE(stage.Detect({}, report, message));
        EXPECT_EQ(message, i == 30 ? "labels: none of the first 30 frames has a colour image" : "");
        EXPECT_EQ(stage.broken(), i >= 30);
    }
    EXPECT_FALSE(stage.Detect(Coloured(), report, message));
}

TEST(ColourlessLabelling, TheThreadGoesOn) {
    Wake owner;
    LabellingThread labelling(StageInColour(), {}, owner);
    for (const bool coloured : {false, true, false, true}) {
        LabellingThread::Job job;
        job.frame = std::make_unique<Frame>(coloured ? Coloured() : Frame());
        ASSERT_EQ(labelling.Offer(std::move(job)), nullptr);
        LabellingThread::Answer answer;
        owner.Wait([&] { return labelling.TryTake(answer); });
        EXPECT_EQ(answer.looked_at, coloured);
        EXPECT_EQ(answer.message, "");
        EXPECT_EQ(answer.job.map.world, 0);
        EXPECT_FALSE(labelling.stopped());
    }
}

// Every second frame is due, and those lack colour.
TEST_F(EngineTest, LabellingInLockstepLooksAtTheNextFrameInColour) {
    config.labels.stride = 2;
    TrackingStage tracking(config.pipeline, Source().info().camera);
    FrameLabelling labelling(config.labels, Source().info().camera);
    labelling.Begin(CupsInColour());
    for (int i = 0; i < 12; ++i) {
        labelling.Detect(i % 2 == 0 ? Frame() : Coloured(), false, tracking);
        EXPECT_EQ(labelling.TakeDetections().has_value(), i % 2 == 1) << i;
    }
    // In all colours, those that are due.
    for (int i = 12; i < 20; ++i) {
        labelling.Detect(Coloured(), false, tracking);
        EXPECT_EQ(labelling.TakeDetections().has_value(), i % 2 == 0) << i;
    }
    EXPECT_EQ(labelling.TakeFailure(), "");
}

// By whatever frame the camera is lost, nor does every frame pay for a detector then. After it, the
// frame of which the detections were not used is made up for.
TEST_F(EngineTest, LabellingInLockstepKeepsItsStrideWhileNothingIsFused) {
    config.labels.stride = 5;
    TrackingStage tracking(config.pipeline, Source().info().camera);
    const auto detected = [&](int lost, int found) {
        FrameLabelling labelling(config.labels, Source().info().camera);
        labelling.Begin(CupsInColour());
        std::vector<int> frames;
        for (int i = 0; i < 22; ++i) {
            labelling.Detect(Coloured(), false, tracking);
            if (labelling.detected()) frames.push_back(i);
            if (i < lost || i >= found) labelling.TakeDetections();
        }
        return frames;
    };
    EXPECT_EQ(detected(22, 22), (std::vector{0, 5, 10, 15, 20}));
    EXPECT_EQ(detected(5, 16), (std::vector{0, 5, 10, 15, 17, 21}));
    EXPECT_EQ(detected(3, 22), (std::vector{0, 8, 13, 18}));
}

// Long before the next detection is due.
TEST_F(EngineTest, LabellingLiveLooksAtALaterFrameInstead) {
    config.loops.enabled = false;
    Wake owner;
    Notices notices{owner};
    LiveLinks links{false, notices, owner};
    std::promise<void> looked;
    std::future<void> seen = looked.get_future();
    LiveMapping mapping(config, Source().info(), nullptr, nullptr, links);
    ASSERT_TRUE(mapping.Start(CupsInColour(&looked), {}, {}).ok());
    const auto send = [&](double stamp_s, bool coloured) {
        MappingTask task;
        task.frame = std::make_unique<Frame>(RoomFrame(0));
        task.frame->stamp_s = stamp_s;
        task.tracked = std::make_unique<TrackedFrame>();
        PrepareFrame(*task.frame, config.pipeline.frame, task.tracked->prepared);
        if (!coloured) task.frame->colour = {};
        task.tracked->report.stamp_s = stamp_s;
        task.tracked->report.first = !coloured;
        task.tracked->report.track.status = TrackStatus::kGood;
        task.tracked->to_fuse = true;
        mapping.Send(std::move(task));
    };
    send(1, false);
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (seen.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready) {
        ASSERT_LT(std::chrono::steady_clock::now(), end) << "no frame in colour was looked at";
        send(1.1, true);
        MapUpdate update;
        while (links.map_updates.TryPop(update)) {
        }
    }
    mapping.Finish();
}

}  // namespace
}  // namespace tessera
