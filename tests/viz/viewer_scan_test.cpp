// The scan view: its layout, its buttons, its advice and the coverage, driven by real input.
#include <X11/keysym.h>

#include "viz/window_fixture.h"

namespace tessera {
namespace {

using Kind = ViewerCommand::Kind;
class ViewerScan : public testing_support::WindowTest {
  protected:
    void SetUp() override {
        first_options_.view_kind = ViewKind::kScan;
        first_options_.max_weight = 128;
        WindowTest::SetUp();
    }
    template <class Predicate>
    double Share(Predicate predicate) {
        const ColourImage picture = viewer_->Picture();
        const ControlRect view = Find("view");
        int hits = 0;
        for (int y = static_cast<int>(view.y); y < static_cast<int>(view.y + view.height); ++y)
            for (int x = static_cast<int>(view.x); x < static_cast<int>(view.x + view.width); ++x)
                hits += predicate(picture(x, y));
        return static_cast<float>(hits) / (view.width * view.height);
    }
    static bool IsInside(const ControlRect& a, const ControlRect& b) {
        return a.x >= b.x && a.y >= b.y && a.x + a.width <= b.x + b.width &&
               a.y + a.height <= b.y + b.height;
    }
    static bool Overlap(const ControlRect& a, const ControlRect& b) {
        return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height &&
               b.y < a.y + a.height;
    }
    // All buttons of the bar are inside the window, and none lies over another.
    void ExpectTidy(float width, float height) {
        const std::vector<std::string> names{"pause",  "save",         "reset",    "coverage",
                                             "follow", "first_person", "view_all", "switch_view",
                                             "help",   "view",         "status"};
        for (std::size_t i = 0; i < names.size(); ++i) {
            const ControlRect a = Find(names[i]);
            EXPECT_TRUE(IsInside(a, {0, 0, width, height})) << names[i];
            EXPECT_GT(a.width, 40) << names[i];
            for (std::size_t k = 0; k < i; ++k)
                EXPECT_FALSE(Overlap(a, Find(names[k]))) << names[i] << " and " << names[k];
        }
        const ControlRect view = Find("view");
        EXPECT_GE(view.width * view.height, 0.8 * width * height);
        for (const char* name : {"legend", "scale_bar", "camera_image"})
            EXPECT_TRUE(IsInside(Find(name), view)) << name;
        EXPECT_FALSE(Overlap(Find("legend"), Find("scale_bar")));
        EXPECT_FALSE(Overlap(Find("camera_image"), Find("scale_bar")));
    }
};

TEST_F(ViewerScan, The3DViewIsLargeAndNothingOverlaps) {
    Frames(3);
    ExpectTidy(1280, 720);
    EXPECT_FALSE(viewer_->FindControl("method.icp"));
    EXPECT_FALSE(viewer_->FindControl("alpha"));
}

class ViewerScanSmall : public ViewerScan {
  protected:
    void SetUp() override {
        first_options_.screen.width = 800;
        first_options_.screen.height = 600;
        ViewerScan::SetUp();
    }
};
TEST_F(ViewerScanSmall, NothingOverlapsOnASmallScreen) {
    Frames(3);
    ExpectTidy(800, 600);
}

TEST_F(ViewerScan, TabAndTheButtonSwitch) {
    Frames(2);
    MoveTo("view");
    Key(XK_Tab);
    EXPECT_TRUE(viewer_->FindControl("method.icp"));
    EXPECT_FALSE(viewer_->FindControl("coverage"));
    Click("switch_view");
    EXPECT_FALSE(viewer_->FindControl("method.icp"));
    Click("switch_view");
    EXPECT_TRUE(viewer_->FindControl("method.icp"));
}

TEST_F(ViewerScan, ButtonsDoTheirWork) {
    Frames(2);
    Click("pause");
    EXPECT_EQ(Commands(), std::vector{Kind::kPause});
    EXPECT_FALSE(viewer_->FindControl("save_mesh"));
    Click("save");
    Click("save_mesh");
    EXPECT_FALSE(viewer_->FindControl("save_mesh"));  // the menu has closed
    Click("save");
    Click("save_scan");
    Click("reset");
    Click("reset.confirm");
    EXPECT_EQ(Commands(),
              (std::vector{Kind::kPause, Kind::kSaveMesh, Kind::kSaveScan, Kind::kReset}));
}

// A menu that is open gets the keys, and Escape closes it: none of them ends the scan.
TEST_F(ViewerScan, KeysInAMenuAreNotTheWindows) {
    Frames(2);
    Click("save");
    ASSERT_TRUE(viewer_->FindControl("save_mesh"));
    Key(XK_q);
    Key(XK_r);
    EXPECT_FALSE(viewer_->FindControl("reset.confirm"));
    ASSERT_TRUE(viewer_->FindControl("save_mesh"));
    Key(XK_Escape);
    EXPECT_FALSE(viewer_->FindControl("save_mesh"));
    // A question that a key has answered takes no more keys.
    Key(XK_r);
    EXPECT_TRUE(viewer_->FindControl("reset.confirm"));
    Key(XK_n);
    Key(XK_Tab);
    EXPECT_TRUE(viewer_->FindControl("method.icp"));
    EXPECT_TRUE(Commands().empty());
}

// A wall seen in one frame is red. After enough frames it has its own colours.
TEST_F(ViewerScan, TheCoverageShowsWhatIsThin) {
    const auto red = [this] {
        return Share([](const Rgb8& c) { return c.r > 90 && c.r > 2 * c.g && c.r > 2 * c.b; });
    };
    Frames(1);
    const double at_first = red();
    EXPECT_GT(at_first, 0.1);
    Click("coverage");
    EXPECT_LT(red(), 0.01);  // the scene's colours
    MoveTo("view", 0.05f);
    Key(XK_c);
    EXPECT_NEAR(red(), at_first, 0.02);
    Frames(40);
    EXPECT_LT(red(), 0.3 * at_first);
}

// The advice comes from the depth image, over the link.
TEST_F(ViewerScan, AdviceIsShownAndGoes) {
    Frames(3);
    EXPECT_FALSE(viewer_->FindControl("hint"));
    auto frame = std::make_shared<Frame>();
    frame->depth_m = DepthImage(160, 120, 0.0f);
    ImageUpdate images;
    images.frame = frame;
    link_.images.Push(std::move(images));
    Rounds(4);
    EXPECT_TRUE(viewer_->FindControl("hint"));
    Click("pause");  // no advice for a camera that is not used
    link_.paused = true;
    Rounds(4);
    EXPECT_FALSE(viewer_->FindControl("hint"));
}

class ViewerScanMessages : public ViewerScan {
  protected:
    void SetUp() override {
        first_options_.message_s = 1e3;  // works on slow machines too
        ViewerScan::SetUp();
    }
};
TEST_F(ViewerScanMessages, TheNewestStandsOverTheView) {
    EXPECT_FALSE(viewer_->FindControl("message"));
    link_.messages.Push("a cable is loose");
    Rounds(3);
    const ControlRect short_one = Find("message");
    EXPECT_TRUE(IsInside(short_one, Find("view")));
    link_.messages.Push("the camera is found nowhere; a new part of the scan begins");
    Rounds(3);
    EXPECT_GT(Find("message").width, short_one.width);
    Click("switch_view");  // there they are listed
    EXPECT_FALSE(viewer_->FindControl("message"));
}

class ViewerScanShortMessages : public ViewerScan {
  protected:
    void SetUp() override {
        first_options_.message_s = 0.2;
        ViewerScan::SetUp();
    }
};
TEST_F(ViewerScanShortMessages, TheyGo) {
    link_.messages.Push("a cable is loose");
    Rounds(3);
    EXPECT_TRUE(Within(20, [&] { return !viewer_->FindControl("message"); }));
}

TEST_F(ViewerScan, FirstPersonLooksFromTheCamerasPlace) {
    Frames(3);
    const auto before = viewer_->Picture();
    Click("first_person");
    Frames(1);
    const auto inside = viewer_->Picture();
    int differ = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
        differ += std::abs(before.data()[i].g - inside.data()[i].g) > 20;
    EXPECT_GT(differ, 20000);
}

}  // namespace
}  // namespace tessera
