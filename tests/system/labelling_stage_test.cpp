#include "system/labelling_stage.h"

#include <stdexcept>

#include "system/engine_fixture.h"

namespace tessera {
namespace {

// Returns detections for a while, then fails with an error or, against its contract, with an
// exception.
class BreakingDetector : public Detector {
  public:
    BreakingDetector(int good, bool throws) : good_(good), throws_(throws) {}
    Result<std::vector<Detection>> Detect(const Frame&) override {
        if (good_-- > 0) {
            Detection sure, doubtful, other;
            sure.name = doubtful.name = "cup", other.name = "dog";
            sure.probability = other.probability = 0.9f, doubtful.probability = 0.3f;
            sure.box = doubtful.box = other.box = {20, 20, 60, 60};
            return std::vector<Detection>{doubtful, sure, other};
        }
        if (throws_) throw std::runtime_error("the network fell over");
        return Status::Error("the network fell over");
    }
    const std::vector<std::string>& class_names() const override { return names_; }

  private:
    int good_;
    bool throws_;
    std::vector<std::string> names_{"cup", "dog"};
};

Labelling Breaking(int good, bool throws) {
    LabelConfig config;
    config.classes = "cup";
    auto detector = std::make_unique<BreakingDetector>(good, throws);
    LabelClasses classes = LabelClasses::Make(config, detector->class_names()).value();
    return {std::move(detector), std::move(classes)};
}

// Detects a person in the middle of each frame, and a cup that the person holds.
class PersonDetector : public Detector {
  public:
    Result<std::vector<Detection>> Detect(const Frame& frame) override {
        Detection person, cup;
        person.name = "person", cup.name = "cup";
        person.probability = cup.probability = 0.9f;
        const auto width = static_cast<float>(frame.depth_m.width()),
                   height = static_cast<float>(frame.depth_m.height());
        person.box = {0.3f * width, 0.2f * height, 0.7f * width, 0.8f * height};
        cup.box = {0.4f * width, 0.4f * height, 0.5f * width, 0.5f * height};
        const PixelBox pixels = PixelsOf(person.box, frame.depth_m.width(), frame.depth_m.height());
        person.mask = Image<std::uint8_t>(pixels.width(), pixels.height(), 1);
        return std::vector<Detection>{person, cup};
    }
    const std::vector<std::string>& class_names() const override { return names_; }

  private:
    std::vector<std::string> names_{"person", "cup"};
};

Labelling Person() {
    LabelConfig config;
    config.classes = "all";
    auto detector = std::make_unique<PersonDetector>();
    LabelClasses classes = LabelClasses::Make(config, detector->class_names()).value();
    return {std::move(detector), std::move(classes)};
}

TEST(LabellingStage, ReportsTheTimeOfColourAsRecorded) {
    Labelling labelling = Breaking(1, false);
    LabelConfig config;
    config.classes = "cup";
    LabellingStage stage(std::move(labelling.detector), std::move(labelling.classes), config,
                         {64, 48, 50, 50, 31.5, 23.5});
    Frame frame;
    frame.stamp_s = 10;
    frame.correction = {-0.01, 0.02};
    frame.colour_stamp_s = 10.01 + 0.02;
    frame.colour = ColourImage(64, 48, Rgb8{90, 90, 90});
    LabelReport report;
    std::string message;
    ASSERT_TRUE(stage.Detect(frame, report, message)) << message;
    EXPECT_EQ(report.stamp_s, frame.stamp_s);
    EXPECT_NEAR(report.colour_stamp_s, 10.01, 1e-9);
}

class LabellingStageTest : public EngineTest, public testing::WithParamInterface<bool> {
  protected:
    void MakeLabelling(bool live, int good) {
        EngineInput input = Input({.count = 20});
        input.labelling = Breaking(good, GetParam());
        if (live)
            engine = std::make_unique<LiveEngine>(std::move(input));
        else
            engine = std::make_unique<LockstepEngine>(std::move(input));
    }
    int TimesSaid() const {
        int times = 0;
        for (const FrameOutcome& o : outcomes)
            times += o.message.starts_with("labelling has stopped, the run continues: ") &&
                     o.message.find("the network fell over") != std::string::npos;
        return times;
    }
    std::int64_t Labelled() const {
        return std::ranges::count_if(outcomes,
                                     [](const FrameOutcome& o) { return o.labels.has_value(); });
    }
};

TEST_P(LabellingStageTest, SaysOnceThatTheDetectorBroke) {
    Labelling labelling = Breaking(1, GetParam());
    LabellingStage stage(std::move(labelling.detector), std::move(labelling.classes), {}, {});
    LabelReport report;
    std::string message;
    EXPECT_TRUE(stage.Detect({}, report, message));
    ASSERT_EQ(report.detections.size(), 1u);  // only the wanted class above the minimum probability
    EXPECT_EQ(report.detections[0].class_id, 1);
    EXPECT_TRUE(message.empty());
    EXPECT_FALSE(stage.Detect({}, report, message));
    EXPECT_NE(message.find("the network fell over"), std::string::npos) << message;
    EXPECT_FALSE(stage.Detect({}, report, message));
    EXPECT_TRUE(message.empty());
}

TEST_P(LabellingStageTest, InLockstepTheScanGoesOn) {
    MakeLabelling(false, 3);
    TakeAll();
    EXPECT_TRUE(engine->status().ok());
    EXPECT_EQ(Count(Kind::kFrame), 20);
    for (const FrameReport* report : Reports()) EXPECT_TRUE(report->tracked());
    EXPECT_EQ(Labelled(), 3);
    EXPECT_EQ(TimesSaid(), 1);
    EXPECT_EQ(Count(Kind::kLabelsEnd), 1);
}

TEST_P(LabellingStageTest, LiveTheScanGoesOn) {
    config.live.queue_frames = 30;
    MakeLabelling(true, 0);
    TakeAll();
    EXPECT_TRUE(engine->status().ok());
    EXPECT_EQ(Count(Kind::kFrame) + Count(Kind::kDropped), 20);
    EXPECT_EQ(Labelled(), 0);
    EXPECT_EQ(TimesSaid(), 1);
    EXPECT_GT(engine->TakeMesh().triangles.size(), 1000u);
}

// By their stamps, 20 frames span two thirds of a second, however fast they arrive.
TEST_P(LabellingStageTest, LiveOnlySoManyFramesASecondAreDetectedIn) {
    config.live.queue_frames = 30;
    config.labels.max_rate_hz = 2;
    config.live.playback_speed = 1;
    MakeLabelling(true, 1000);
    TakeAll();
    EXPECT_GE(Labelled(), 1);
    EXPECT_LE(Labelled(), 2);
}

// A person is masked from the first frame on, even when standing still.
TEST_F(EngineTest, WhatADetectorCallsAPersonIsNotFusedInLockstep) {
    EngineInput input = Input({.count = 12});
    input.labelling = Person();
    engine = std::make_unique<LockstepEngine>(std::move(input));
    TakeAll();
    for (const FrameOutcome& o : outcomes) {
        if (o.kind != Kind::kFrame) continue;
        ASSERT_TRUE(o.report.tracked());
        ASSERT_NE(o.report.moving, nullptr) << o.report.index;
        const Image<std::uint8_t>& moving = o.report.moving->moving;
        EXPECT_EQ(moving(moving.width() / 2, moving.height() / 2), 1) << o.report.index;
        EXPECT_EQ(moving(moving.width() / 12, moving.height() / 12), 0) << o.report.index;
        ASSERT_TRUE(o.labels.has_value()) << o.report.index;
        ASSERT_EQ(o.labels->detections.size(), 1u) << o.report.index;  // without the person
        EXPECT_EQ(o.labels->detections[0].name, "cup");
    }
}

TEST_F(EngineTest, WhatADetectorCallsAPersonIsNotFusedLiveOnceItAnswered) {
    config.live.queue_frames = 40;
    EngineInput input = Input({.count = 40});
    input.labelling = Person();
    engine = std::make_unique<LiveEngine>(std::move(input));
    TakeAll();
    std::int64_t masked = 0;
    for (const FrameReport* report : Reports()) masked += report->moving != nullptr;
    EXPECT_GT(masked, 0);
}

// The user switches labelling off, and on again without cups.
class SwitchedLabelling : public EngineTest, public testing::WithParamInterface<bool> {
  protected:
    void TearDown() override { engine.reset(); }  // the link must outlive it
    ViewerLink link;
};

TEST_P(SwitchedLabelling, FollowsTheSettings) {
    viewer = &link;
    config.labels.max_rate_hz = 1000;
    EngineInput input = Input({.live = true});
    input.labelling = Person();
    const auto cup = static_cast<std::size_t>(input.labelling.classes.IdOf("cup"));
    if (GetParam())
        engine = std::make_unique<LiveEngine>(std::move(input));
    else
        engine = std::make_unique<LockstepEngine>(std::move(input));
    const auto next_count = [&] {
        while (Next())
            if (outcomes.back().labels) return outcomes.back().labels->detections.size();
        return std::size_t{99};
    };
    EXPECT_EQ(next_count(), 1u);
    ViewerSettings settings;
    settings.labels.on = false;
    link.settings.Push(ViewerSettings(settings));
    // Live, frames that were on their way are still labelled.
    for (int quiet = 0; quiet < 30; quiet += outcomes.back().kind == Kind::kFrame) {
        ASSERT_TRUE(Next());
        ASSERT_LT(Reports().size(), 200u) << "labelling goes on";
        if (outcomes.back().labels) quiet = 0;
    }
    settings.labels.on = true;
    settings.labels.ignored[cup] = true;
    link.settings.Push(ViewerSettings(settings));
    EXPECT_EQ(next_count(), 0u);
    EXPECT_TRUE(outcomes.back().labels->ignored[cup]);  // for a map made again later
    Ask(Command::kStop);
    TakeAll();
}

INSTANTIATE_TEST_SUITE_P(LockstepAndLive, SwitchedLabelling, testing::Bool());
INSTANTIATE_TEST_SUITE_P(ByErrorAndByException, LabellingStageTest, testing::Bool());

}  // namespace
}  // namespace tessera
