// A window on a virtual display, driven with real events of the mouse and the keyboard.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/stopwatch.h"
#include "viz/viewer.h"
#include "viz/virtual_display.h"

namespace tessera::testing_support {

class DrivenWindow : public testing::Test {
  protected:
    // Skips without Xvfb.
    void SetUp() override {
        std::string why;
        display_ = VirtualDisplay::Start(why);
        if (!display_) GTEST_SKIP() << why;
    }
    // One iteration of the window. False: it closes.
    virtual bool RunOnce() = 0;
    virtual std::optional<ControlRect> FindControl(const std::string& name) const = 0;

    void Rounds(int n) {
        for (int i = 0; i < n; ++i) ASSERT_TRUE(RunOnce());
    }
    // Runs the window until the condition holds, at most `most` times.
    bool Until(const std::function<bool()>& condition, int most = 300) {
        for (int i = 0; i < most && !condition(); ++i)
            if (!RunOnce()) return condition();
        return condition();
    }
    // The same for what needs time: at most so many seconds.
    bool Within(double seconds, const std::function<bool()>& condition) {
        const Stopwatch watch;
        while (!condition() && watch.ElapsedMs() < 1000 * seconds)
            if (!RunOnce()) break;
        return condition();
    }
    ControlRect Find(const std::string& name) const {
        const auto rect = FindControl(name);
        EXPECT_TRUE(rect) << "no control " << name;
        return rect.value_or(ControlRect{});
    }
    // `along` in [0, 1] is the position from the left edge of the control.
    void MoveTo(const std::string& name, float along = 0.5f) {
        const ControlRect rect = Find(name);
        display_->MoveTo(rect.x + along * rect.width, rect.y + rect.height / 2);
        Rounds(3);
    }
    void Click(const std::string& name, float along = 0.5f) {
        MoveTo(name, along);
        display_->Press(1);
        Rounds(2);
        display_->Release(1);
        Rounds(4);
    }
    void Key(unsigned long keysym) {
        display_->PressKey(keysym);
        display_->ReleaseKey(keysym);
        Rounds(4);
    }

    std::unique_ptr<VirtualDisplay> display_;
};

}  // namespace tessera::testing_support
