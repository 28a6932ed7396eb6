// Stub for builds without ImGui, GLFW or OpenGL; opening the window returns an error.
#include "viz/start_screen.h"
#include "viz/viewer.h"

namespace tessera {
namespace {

Status Off() {
    return Status::Error(
        "this build has no window; install libimgui-dev, libglfw3-dev and libepoxy-dev and "
        "rebuild");
}

}  // namespace

struct Viewer::Impl {};
Result<std::unique_ptr<Viewer>> Viewer::Open(ViewerLink&, const ViewerOptions&) { return Off(); }
Result<std::unique_ptr<Viewer>> Viewer::OpenModel(ViewedModel, const ViewerOptions&) {
    return Off();
}
Viewer::~Viewer() = default;
// Never called, because no object exists.
void Viewer::Run() {}
bool Viewer::RunOnce() { return false; }
ColourImage Viewer::Picture() { return {}; }
std::optional<ControlRect> Viewer::FindControl(const std::string&) const { return std::nullopt; }

struct StartScreen::Impl {
    StartChoices choices;
};
Result<std::unique_ptr<StartScreen>> StartScreen::Open(StartServices, const ScreenOptions&) {
    return Off();
}
StartScreen::~StartScreen() = default;
std::vector<std::string> StartScreen::Run() { return {}; }
bool StartScreen::RunOnce() { return false; }
bool StartScreen::Wait() { return false; }
void StartScreen::Refuse(const std::string&) {}
std::shared_ptr<Window> StartScreen::window() const { return nullptr; }
const StartChoices& StartScreen::choices() const { return impl_->choices; }
ColourImage StartScreen::Picture() { return {}; }
std::optional<ControlRect> StartScreen::FindControl(const std::string&) const {
    return std::nullopt;
}

}  // namespace tessera
