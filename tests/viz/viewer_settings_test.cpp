// Clicks the controls of settings and checks what the system receives.
#include <X11/keysym.h>

#include <utility>

#include "viz/viewer_controls.h"
#include "viz/viewer_state.h"

namespace tessera {
namespace {

TEST_F(ViewerControls, MethodsAreSelected) {
    Frames(2);
    for (const auto& [name, method] : {std::pair{"method.icp", TrackingMethod::kIcp},
                                       {"method.sdf-geometric", TrackingMethod::kSdfGeometric},
                                       {"method.icp-rgb", TrackingMethod::kIcpRgb},
                                       {"method.sdf", TrackingMethod::kSdf}}) {
        Click(name);
        const ViewerSettings* settings = LastSettings();
        ASSERT_TRUE(settings) << name;
        EXPECT_EQ(settings->method, method) << name;
    }
    EXPECT_EQ(system_->settings().size(), 4u);
}

// `--switch FRAME:METHOD`: the run has another method than the window opened with.
TEST_F(ViewerControls, AMethodThatTheRunSwitchedToIsShownAndStays) {
    const auto lit = [this](const char* name) {
        const ColourImage picture = viewer_->Picture();
        const ControlRect button = Find(name);
        const Rgb8& c =
            picture(static_cast<int>(button.x) + 4, static_cast<int>(button.y + button.height / 2));
        return c.r == 47 && c.g == 102 && c.b == 176;
    };
    Frames(2);
    EXPECT_TRUE(lit("method.sdf"));
    FrameUpdate switched;
    switched.report.index = 2;
    switched.report.method = TrackingMethod::kIcp;
    link_.frames.Push(std::move(switched));
    Rounds(3);
    EXPECT_TRUE(lit("method.icp"));
    EXPECT_FALSE(lit("method.sdf"));
    Click("fusing");
    ASSERT_NE(LastSettings(), nullptr);
    EXPECT_EQ(LastSettings()->method_choices, 0);  // the method is as the run wants it
    Click("method.icp-rgb");
    EXPECT_EQ(LastSettings()->method, TrackingMethod::kIcpRgb);
    EXPECT_EQ(LastSettings()->method_choices, 1);
    Frames(1);
    EXPECT_EQ(system_->settings().size(), 2u);
}

TEST_F(ViewerControls, AlphaIsAutomaticOrSet) {
    Frames(2);
    Click("alpha", 0.9f);  // disabled
    EXPECT_EQ(LastSettings(), nullptr);
    Click("alpha.auto");
    ASSERT_NE(LastSettings(), nullptr);
    EXPECT_FALSE(LastSettings()->auto_alpha);
    Click("alpha", 0.2f);
    const double low = LastSettings()->alpha;
    MoveTo("alpha", 0.2f);
    display_->Press(1);
    Rounds(2);
    MoveTo("alpha", 0.8f);
    display_->Release(1);
    Rounds(3);
    const double high = LastSettings()->alpha;
    EXPECT_GT(low, 0.0005);
    EXPECT_LT(high, 2);
    EXPECT_GT(high, 20 * low);  // the scale is logarithmic
    EXPECT_FALSE(LastSettings()->auto_alpha);
}

TEST_F(ViewerControls, SwitchesAndDepth) {
    Frames(1);
    Click("fusing");
    ASSERT_NE(LastSettings(), nullptr);
    EXPECT_FALSE(LastSettings()->fusing);
    EXPECT_EQ(LastSettings()->loops, true);
    Click("loops");
    EXPECT_EQ(LastSettings()->loops, false);
    Click("prealign");
    EXPECT_FALSE(LastSettings()->prealign);
    Click("prediction");
    EXPECT_FALSE(LastSettings()->show_prediction);
    Click("max_depth", 0.1f);
    EXPECT_LT(LastSettings()->max_depth_m, 2.5);
    EXPECT_GT(LastSettings()->max_depth_m, 0.5);
    Click("fusing");
    EXPECT_TRUE(LastSettings()->fusing);
    EXPECT_FALSE(LastSettings()->prealign);  // all settings are sent together
}

TEST_F(ViewerControls, ViewsAreRasterisedAndClassesChosen) {
    LabelConfig config;
    config.classes = "cup book";
    link_.classes.Push(LabelClasses(LabelClasses::Make(config, {}).value()));
    Frames(1);
    Click("raster");
    ASSERT_NE(LastSettings(), nullptr);
    EXPECT_EQ(LastSettings()->prediction, IcpTracker::Prediction::kRaster);
    EXPECT_EQ(LastSettings()->labels.prediction, LabelPrediction::kRaster);
    Click("raster");
    EXPECT_EQ(LastSettings()->prediction, IcpTracker::Prediction::kRayCast);
    EXPECT_EQ(LastSettings()->labels.prediction, LabelPrediction::kRayCast);
    Click("labelling");
    EXPECT_FALSE(LastSettings()->labels.on);
    EXPECT_FALSE(viewer_->FindControl("class.book"));
    Click("classes");
    Click("class.book");
    EXPECT_TRUE(LastSettings()->labels.ignored[2]);
    EXPECT_EQ(LastSettings()->labels.ignored.count(), 1u);
    Click("class.book");
    EXPECT_TRUE(LastSettings()->labels.ignored.none());
}

class ViewerDetectors : public ViewerControls {
  protected:
    void SetUp() override {
        first_options_.models = {"models/a.onnx", "models/b.onnx"};
        ViewerControls::SetUp();
    }
};

TEST_F(ViewerDetectors, ADetectorIsChosenFromTheListOrByItsPath) {
    Frames(1);
    Click("detector.choose");
    Click("detector.b.onnx");
    ASSERT_NE(LastSettings(), nullptr);
    EXPECT_EQ(LastSettings()->detector, "models/b.onnx");
    EXPECT_FALSE(viewer_->FindControl("detector.path"));  // the list has closed
    Click("detector.choose");
    Click("detector.path");
    for (const unsigned long key : {XK_q, XK_period, XK_c, XK_f, XK_g}) Key(key);
    Click("detector.use");
    EXPECT_EQ(LastSettings()->detector, "q.cfg");  // q, in a text, is no key of the window
    EXPECT_TRUE(Commands().empty());
    const int choices = LastSettings()->detector_choice;
    Click("detector.choose");
    Click("detector.use");  // the same once more: it may have failed
    EXPECT_EQ(LastSettings()->detector, "q.cfg");
    EXPECT_EQ(LastSettings()->detector_choice, choices + 1);
}

TEST(ViewerDetectorName, IsThatOfTheOneInUse) {
    ViewerLink link;
    ViewerOptions options;
    options.detector = "a.onnx";
    ViewerState state(&link, options);
    state.UseDetector("b.onnx");
    EXPECT_EQ(state.detector(), "a.onnx");  // b is not open yet, or was refused
    link.detectors.Push("b.onnx");
    EXPECT_TRUE(state.system.Take(link, 0));
    EXPECT_EQ(state.detector(), "b.onnx");
}

}  // namespace
}  // namespace tessera
