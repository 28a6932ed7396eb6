// A window on a virtual display, connected to a stepped system, with simulated user input.
#pragma once

#include <memory>
#include <string>

#include "support/box_room_source.h"
#include "support/temp_folder.h"
#include "viz/driven_window.h"
#include "viz/stepped_system.h"

namespace tessera::testing_support {

class WindowTest : public DrivenWindow {
  protected:
    void SetUp() override {
        DrivenWindow::SetUp();
        if (!display_) return;
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
        options.screen.wait_s = 0;
        options.max_fps = 1e9;
        options.screen.double_click_s = 1e3;  // works on slow machines too
        auto viewer = Viewer::Open(link_, options);
        ASSERT_TRUE(viewer.ok()) << viewer.message();
        viewer_ = std::move(viewer.value());
        Rounds(5);
    }
    void TearDown() override { viewer_.reset(); }

    bool RunOnce() override { return viewer_->RunOnce(); }
    std::optional<ControlRect> FindControl(const std::string& name) const override {
        return viewer_->FindControl(name);
    }
    // Steps the system by n frames and waits until the window has taken them.
    void Frames(int n) {
        for (int i = 0; i < n; ++i) {
            ASSERT_TRUE(system_->Step());
            ASSERT_TRUE(Until([&] { return link_.meshes.empty() && link_.frames.empty(); }));
        }
        Rounds(3);
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
    // Share of the pixels of the 3D view for which the predicate holds.
    template <class Predicate>
    double Share(const ColourImage& picture, Predicate predicate) {
        const ControlRect view = Find("view");
        int all = 0, hits = 0;
        for (int y = static_cast<int>(view.y) + 60; y < static_cast<int>(view.y + view.height); ++y)
            for (int x = static_cast<int>(view.x); x < static_cast<int>(view.x + view.width);
                 ++x, ++all)
                hits += predicate(picture(x, y));
        return static_cast<double>(hits) / all;
    }
    static bool IsBackground(const Rgb8& c) { return std::max({c.r, c.g, c.b}) < 62; }

    TempFolder folder_;
    ViewerOptions first_options_;  // a test's own, completed by SetUp
    ViewerLink link_;
    std::unique_ptr<SteppedSystem> system_;
    std::unique_ptr<Viewer> viewer_;
};

}  // namespace tessera::testing_support
