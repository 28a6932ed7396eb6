// Ways a window ends: closed by the user, by the end of the run, or by the loss of its display.
// Also tests opening a window without a display.
#include <X11/keysym.h>

#include <cstdlib>

#include "viz/window_fixture.h"

namespace tessera {
namespace {

using Kind = ViewerCommand::Kind;

TEST(ViewerWithoutDisplay, SaysSoInOneLine) {
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    ViewerLink link;
    const auto viewer = Viewer::Open(link, {});
    ASSERT_FALSE(viewer.ok());
    EXPECT_EQ(viewer.message(), "a window needs a display, and there is none: set DISPLAY");
    setenv("DISPLAY", ":987654", 1);
    EXPECT_EQ(Viewer::Open(link, {}).message(), viewer.message());
}

class ViewerEnd : public testing_support::WindowTest {
  protected:
    bool StopWasSent() {
        ViewerCommand command;
        return link_.commands.TryPop(command) && command.kind == Kind::kStop &&
               link_.commands.empty();
    }
};

TEST_F(ViewerEnd, TheCloseButtonStopsTheRun) {
    Frames(2);
    // Close while a mouse button is held down on the view and frames are still arriving.
    MoveTo("view");
    display_->Press(1);
    Rounds(1);
    ASSERT_TRUE(system_->Step());
    ASSERT_TRUE(display_->AskToClose("test - Tessera"));
    EXPECT_TRUE(Until([&] { return !viewer_->RunOnce(); }));
    EXPECT_FALSE(viewer_->RunOnce());
    EXPECT_TRUE(StopWasSent());
    display_->Release(1);
}

TEST_F(ViewerEnd, SoDoesAKey) {
    Frames(1);
    MoveTo("view");
    display_->PressKey(XK_q);
    viewer_->Run();  // returns
    EXPECT_TRUE(StopWasSent());
}

TEST_F(ViewerEnd, AnEndedRunStaysToBeLookedAt) {
    Frames(1);
    link_.ended = true;
    Rounds(20);
    ASSERT_TRUE(display_->AskToClose("test - Tessera"));
    EXPECT_TRUE(Until([&] { return !viewer_->RunOnce(); }));
    EXPECT_TRUE(link_.commands.empty());
}

TEST_F(ViewerEnd, ClosesAtTheEndIfAsked) {
    viewer_.reset();
    ViewerOptions options;
    options.close_at_end = true;
    options.screen.wait_s = 0;
    auto viewer = Viewer::Open(link_, options);
    ASSERT_TRUE(viewer.ok()) << viewer.message();
    EXPECT_TRUE(viewer.value()->RunOnce());
    link_.ended = true;
    EXPECT_FALSE(viewer.value()->RunOnce());
    EXPECT_TRUE(link_.commands.empty());
}

// The X server dies. The process must survive.
TEST_F(ViewerEnd, TheLossOfTheDisplayIsAClose) {
    Frames(2);
    display_->Kill();
    EXPECT_TRUE(Until([&] { return !viewer_->RunOnce(); }));
    EXPECT_TRUE(StopWasSent());
    EXPECT_TRUE(viewer_->Picture().empty());
    viewer_.reset();
}

TEST_F(ViewerEnd, OneAfterAnother) {
    for (int i = 0; i < 3; ++i) {
        viewer_.reset();
        ViewerOptions options;
        options.screen.wait_s = 0;
        auto viewer = Viewer::Open(link_, options);
        ASSERT_TRUE(viewer.ok()) << viewer.message();
        viewer_ = std::move(viewer.value());
        Rounds(3);
    }
}

}  // namespace
}  // namespace tessera
