// A window on a virtual display that shows a model, with simulated user input.
#pragma once

#include <memory>
#include <string>

#include "viz/driven_window.h"

namespace tessera::testing_support {

class ModelWindow : public DrivenWindow {
  protected:
    void Open(ViewedModel model) {
        ViewerOptions options = options_;
        options.screen.wait_s = 0;
        options.max_fps = 1e9;
        auto viewer = Viewer::OpenModel(std::move(model), options);
        ASSERT_TRUE(viewer.ok()) << viewer.message();
        viewer_ = std::move(viewer.value());
        Rounds(5);
        MoveTo("view");  // keys go to the window under the pointer
    }
    void TearDown() override { viewer_.reset(); }
    bool RunOnce() override { return viewer_->RunOnce(); }
    std::optional<ControlRect> FindControl(const std::string& name) const override {
        return viewer_->FindControl(name);
    }

    ViewerOptions options_;  // a test's own, completed by Open
    std::unique_ptr<Viewer> viewer_;
};

}  // namespace tessera::testing_support
