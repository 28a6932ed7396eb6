// A window on a virtual display, connected to a stepped system, with simulated user input.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

#include "support/box_room_source.h"
#include "support/temp_folder.h"
#include "viz/stepped_system.h"
#include "viz/viewer.h"
#include "viz/virtual_display.h"

namespace tessera::testing_support {

class WindowTest : public testing::Test {
  protected:
    void SetUp() override {
        std::string why;
        display_ = VirtualDisplay::Start(why);
        if (!display_) GTEST_SKIP() << why;
        PipelineConfig config;
        config.map.voxel_size_m = 0.04;
        config.map.truncation_m = 0.16;
        system_ = std::make_unique<SteppedSystem>(link_, std::make_unique<BoxRoomSource>(), config);
        ViewerOptions options = first_options_;
        options.title = "test";
        options.output_folder = folder_.path();
        options.camera = system_->camera();
        options.truncation_m = 0.16;
        options.labelled = true;
        options.settings.loops = true;
        options.wait_s = 0;
        options.max_fps = 1e9;
        options.double_click_s = 1e3;  // works on slow machines too
        auto viewer = Viewer::Open(link_, options);
        ASSERT_TRUE(viewer.ok()) << viewer.message();
        viewer_ = std::move(viewer.value());
        Rounds(5);
    }
    void TearDown() override { viewer_.reset(); }

    void Rounds(int n) {
        for (int i = 0; i < n; ++i) ASSERT_TRUE(viewer_->RunOnce());
    }
    // Runs the window until the condition holds, at most `most` times.
    bool Until(const std::function<bool()>& condition, int most = 300) {
        for (int i = 0; i < most && !condition(); ++i)
            if (!viewer_->RunOnce()) return condition();
        return condition();
    }
    // Steps the system by n frames and waits until the window has taken them.
    void Frames(int n) {
        for (int i = 0; i < n; ++i) {
            ASSERT_TRUE(system_->Step());
            ASSERT_TRUE(Until([&] { return link_.meshes.empty() && link_.frames.empty(); }));
        }
        Rounds(3);
    }
    ControlRect Find(const std::string& name) {
        const auto rect = viewer_->FindControl(name);
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
    // The commands that the system has received after one more step.
    std::vector<ViewerCommand::Kind> Commands() {
        system_->Step();
        std::vector<ViewerCommand::Kind> kinds;
        for (const ViewerCommand& command : system_->commands()) kinds.push_back(command.kind);
        Until([&] { return link_.meshes.empty() && link_.frames.empty(); });
        return kinds;
    }
    const ViewerSettings* LastSettings() {
        system_->Step();
        Until([&] { return link_.meshes.empty() && link_.frames.empty(); });
        return system_->settings().empty() ? nullptr : &system_->settings().back();
    }

    TempFolder folder_;
    ViewerOptions first_options_;  // a test's own, completed by SetUp
    ViewerLink link_;
    std::unique_ptr<VirtualDisplay> display_;
    std::unique_ptr<SteppedSystem> system_;
    std::unique_ptr<Viewer> viewer_;
};

}  // namespace tessera::testing_support
