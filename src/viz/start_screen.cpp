#include "viz/start_screen.h"

#include <imgui.h>

#include "core/stopwatch.h"
#include "viz/start_state.h"
#include "viz/widgets.h"
#include "viz/window.h"

namespace tessera {
namespace {

// After the last input, ImGui needs a few rounds until hovering and popups have settled.
constexpr int kStartSettlingRounds = 3;
constexpr double kStartFramePeriod_s = 1.0 / 60, kStartLongest_s = 0.5;

}  // namespace

// Members are destroyed in reverse order: the window with its context last.
struct StartScreen::Impl {
    Impl(std::shared_ptr<Window> opened, StartServices services, const ScreenOptions& given)
        : window(std::move(opened)), options(given), state(std::move(services)) {}

    void DrawFrame();
    bool IsClosing() const { return state.close || window->ShouldClose(); }
    void Iterate();

    std::shared_ptr<Window> window;
    const ScreenOptions options;
    StartState state;
    Stopwatch clock;
    double drawn_at_s = -1e9;
    int rounds_to_draw = kStartSettlingRounds;
};

Result<std::unique_ptr<StartScreen>> StartScreen::Open(StartServices services,
                                                       const ScreenOptions& options) {
    Result<std::shared_ptr<Window>> window =
        Window::OpenOrKeep(nullptr, "Tessera", options.width, options.height, options.scale);
    if (!window.ok()) return window.status();
    return std::unique_ptr<StartScreen>(new StartScreen(
        std::make_unique<Impl>(std::move(window.value()), std::move(services), options)));
}

StartScreen::StartScreen(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
StartScreen::~StartScreen() = default;

std::shared_ptr<Window> StartScreen::window() const { return impl_->window; }
const StartChoices& StartScreen::choices() const { return impl_->state.choices; }

std::vector<std::string> StartScreen::Run() {
    while (RunOnce()) {
    }
    return impl_->state.decision;
}

void StartScreen::Refuse(const std::string& why) {
    StartState& state = impl_->state;
    state.decision.clear();
    state.opening = state.close = false;
    state.error = why;
    impl_->window->SetTitle("Tessera");
    if (!impl_->window->ShouldClose()) impl_->window->SetShown(true);
    impl_->rounds_to_draw = kStartSettlingRounds;
}

void StartScreen::Impl::DrawFrame() {
    window->BeginFrame();
    state.controls.BeginFrame();
    DrawStart(state);
    window->EndFrame();
}

void StartScreen::Impl::Iterate() {
    ImGui::GetIO().MouseDoubleClickTime = static_cast<float>(options.double_click_s);
    const double now_s = clock.ElapsedMs() / 1000;
    const bool input = window->WaitForInput(options.wait_s), news = state.Update();
    if (input || news) rounds_to_draw = kStartSettlingRounds;
    if (now_s - drawn_at_s > kStartLongest_s && rounds_to_draw == 0) rounds_to_draw = 1;
    for (const Window::Key& key : window->TakeKeys())
        if (!TakesKey(key.key)) state.OnKey(key.key);
    if (rounds_to_draw == 0 || window->is_minimised()) return;
    if (options.wait_s > 0 && now_s - drawn_at_s < kStartFramePeriod_s) return;
    --rounds_to_draw;
    drawn_at_s = now_s;
    DrawFrame();
    window->Show();
}

bool StartScreen::RunOnce() {
    if (impl_->IsClosing()) return false;
    impl_->Iterate();
    return impl_->state.decision.empty() && !impl_->IsClosing();
}

bool StartScreen::Wait() {
    if (!impl_->state.opening) impl_->rounds_to_draw = kStartSettlingRounds;
    impl_->state.opening = true;
    impl_->Iterate();
    if (impl_->state.close) impl_->window->Close();  // of the run, too
    return !impl_->IsClosing();
}

ColourImage StartScreen::Picture() {
    if (impl_->window->ShouldClose() || impl_->window->is_minimised()) return {};
    for (int i = 0; i < kStartSettlingRounds; ++i) impl_->DrawFrame();
    return impl_->window->Read();
}

std::optional<ControlRect> StartScreen::FindControl(const std::string& name) const {
    return impl_->state.controls.Find(name);
}

}  // namespace tessera
