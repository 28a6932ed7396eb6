// Another detector is chosen while a run is in progress, or the first one.
#include <atomic>

#include "system/engine_fixture.h"

namespace tessera {
namespace {

// Detects one object in the middle of each frame.
class OneThing : public Detector {
  public:
    explicit OneThing(const std::string& name) : names_{name} {}
    Result<std::vector<Detection>> Detect(const Frame& frame) override {
        Detection thing;
        thing.name = names_[0];
        thing.probability = 0.9f;
        const auto width = static_cast<float>(frame.depth_m.width()),
                   height = static_cast<float>(frame.depth_m.height());
        thing.box = {0.3f * width, 0.3f * height, 0.7f * width, 0.7f * height};
        return std::vector<Detection>{thing};
    }
    const std::vector<std::string>& class_names() const override { return names_; }

  private:
    std::vector<std::string> names_;
};

LabelConfig CupsAndBooks() {
    LabelConfig config;
    config.classes = "cup book";
    return config;
}

// Stands for files: "cup", "book" and "tree" can be opened.
Result<Labelling> OpenOneThing(const std::string& name) {
    if (name != "cup" && name != "book" && name != "tree")
        return Status::Error(name + ": no such file");
    auto detector = std::make_unique<OneThing>(name);
    return Labelling{std::move(detector), LabelClasses::Make(CupsAndBooks(), {}).value()};
}

class DetectorChangeLabelling : public EngineTest, public testing::WithParamInterface<bool> {
  protected:
    void TearDown() override { engine.reset(); }  // the link must outlive it

    void Begin(bool with_labels) {
        viewer = &link;
        config.labels = CupsAndBooks();
        config.labels.max_rate_hz = 1000;
        EngineInput input = Input({.live = true});
        input.open_detector = [this](const std::string& name) -> Result<Labelling> {
            if (name != "late") return OpenOneThing(name);
            if (++tries == 1) return Status::Error("late: not there yet");
            return OpenOneThing("book");
        };
        if (with_labels) input.labelling = std::move(OpenOneThing("cup").value());
        if (GetParam())
            engine = std::make_unique<LiveEngine>(std::move(input));
        else
            engine = std::make_unique<LockstepEngine>(std::move(input));
    }
    void Choose(const std::string& detector) {
        settings.detector = detector;
        ++settings.detector_choice;
        link.settings.Push(ViewerSettings(settings));
    }
    // Runs on until there is this detection, at most `most` outcomes other than detections.
    bool Detects(const std::string& name, int most = 400) {
        for (int i = 0; i < most && Next(); i += outcomes.back().kind != Kind::kLabels) {
            const auto& labels = outcomes.back().labels;
            if (labels && labels->detections.size() == 1 && labels->detections[0].name == name)
                return true;
        }
        return false;
    }
    bool Says(const std::string& text, int most = 400) {
        for (int i = 0; i < most && Next(); i += outcomes.back().kind != Kind::kLabels)
            if (outcomes.back().message.find(text) != std::string::npos) return true;
        return false;
    }
    void End() {
        Ask(Command::kStop);
        TakeAll();
        EXPECT_TRUE(engine->status().ok());
        for (const FrameReport* report : Reports()) EXPECT_TRUE(report->tracked());
    }

    ViewerLink link;
    ViewerSettings settings;
    std::atomic<int> tries{0};  // to open "late"
};

TEST_P(DetectorChangeLabelling, AnotherTakesOver) {
    Begin(true);
    ASSERT_TRUE(Detects("cup"));
    Choose("book");
    ASSERT_TRUE(Detects("book"));
    EXPECT_EQ(Count(Kind::kLabelsBegin), 1);
    End();
}

TEST_P(DetectorChangeLabelling, OneThatCannotBeOpenedChangesNothing) {
    Begin(true);
    ASSERT_TRUE(Detects("cup"));
    Choose("nowhere");
    ASSERT_TRUE(Says("the detector was not changed: nowhere: no such file"));
    ASSERT_TRUE(Detects("cup"));
    Choose("tree");  // can be opened, but knows neither cups nor books
    ASSERT_TRUE(Says("knows none of the classes"));
    ASSERT_TRUE(Detects("cup"));
    EXPECT_EQ(Count(Kind::kLabelsBegin), 0);
    End();
}

// Only when the user says so: all settings are sent together.
TEST_P(DetectorChangeLabelling, OneThatWasRefusedIsTriedAgainWhenItIsChosenAgain) {
    Begin(true);
    ASSERT_TRUE(Detects("cup"));
    Choose("late");
    ASSERT_TRUE(Says("the detector was not changed: late: not there yet"));
    settings.max_depth_m = 4;
    link.settings.Push(ViewerSettings(settings));
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(Detects("cup"));
    EXPECT_EQ(tries, 1);
    Choose("late");
    ASSERT_TRUE(Detects("book"));
    EXPECT_EQ(tries, 2);
    ASSERT_EQ(Count(Kind::kLabelsBegin), 1);
    for (const FrameOutcome& o : outcomes)
        if (o.kind == Kind::kLabelsBegin) {
            EXPECT_EQ(o.detector, "late");
        }
    End();
}

TEST_P(DetectorChangeLabelling, ARunWithoutLabelsBeginsThem) {
    Begin(false);
    while (Reports().size() < 3) ASSERT_TRUE(Next());
    Choose("nowhere");
    ASSERT_TRUE(Says("no such file"));
    Choose("book");
    ASSERT_TRUE(Detects("book"));
    ASSERT_EQ(Count(Kind::kLabelsBegin), 1);
    for (const FrameOutcome& o : outcomes)
        if (o.kind == Kind::kLabelsBegin) {
            EXPECT_EQ(o.classes->count(), 2);
        }
    for (int i = 0; i < 12; ++i) ASSERT_TRUE(Detects("book"));
    End();
    const TriangleMesh mesh = engine->TakeMesh();
    const auto labelled = std::ranges::count_if(
        mesh.labels, [](const VertexLabel& label) { return label != VertexLabel{}; });
    EXPECT_GT(labelled, 100);
    ASSERT_EQ(engine->objects().size(), 1u);
    EXPECT_EQ(engine->objects()[0].class_name, "book");
}

INSTANTIATE_TEST_SUITE_P(LockstepAndLive, DetectorChangeLabelling, testing::Bool());

}  // namespace
}  // namespace tessera
