#include "viz/viewer.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "core/stopwatch.h"
#include "io/image_io.h"
#include "viz/panels.h"
#include "viz/scene_view.h"
#include "viz/viewer_state.h"
#include "viz/widgets.h"
#include "viz/window.h"

namespace tessera {
namespace {

// After the last input or update, ImGui needs a few rounds until hovering and popups have settled.
constexpr int kSettlingRounds = 3;
// A running system's window is drawn at least this often.
constexpr double kLongest_s = 1;
// Who scans looks at what is before the camera.
constexpr double kNearer = 0.65;
// Software rendering uses CPU time that the system needs. Unless the user moves the view, it is
// redrawn at most this often, and for at most this share of the time.
constexpr double kSoftwareViewPeriodS = 0.25, kSoftwareShare = 0.1;

struct Layout {
    ControlRect left, view, plots, images;
};

Layout LayOut(float width, float height, bool with_system) {
    if (!with_system) return {.left = {}, .view = {0, 0, width, height}, .plots = {}, .images = {}};
    const float left = std::min(Scaled(300), 0.4f * width),
                right = std::clamp(0.18f * width, Scaled(150), Scaled(232));
    const float plots = std::min(Scaled(158), 0.35f * height);
    const float middle = std::max(width - left - right - 2, 1.0f),
                view = std::max(height - plots - 1, 1.0f);
    return {.left = {0, 0, left, height},
            .view = {left + 1, 0, middle, view},
            .plots = {left + 1, view + 1, middle, plots},
            .images = {width - right, 0, right, height}};
}

}  // namespace

// Members are destroyed in reverse order: the window with its context last.
struct Viewer::Impl {
    Impl(std::unique_ptr<Window> opened, ViewerLink* link, const ViewerOptions& options)
        : window(std::move(opened)), state(link, options) {}

    bool RunOnce();
    void DrawFrame(bool smooth);
    bool DrawPanels(bool may_redraw, bool smooth);
    bool DrawScan(bool may_redraw, bool smooth);
    bool DrawExpert(bool may_redraw, bool smooth);
    bool MayRedrawView(double now_s) const;
    void TakeScreenshot();
    double FramePeriodS() const;

    std::unique_ptr<Window> window;
    ViewerState state;
    std::unique_ptr<SceneView> scene;
    ImagesPanel images;
    ScanPanel scan;
    Stopwatch clock;
    double drawn_at_s = -1e9, view_drawn_at_s = -1e9, view_cost_s = 0, followed_at_s = 0;
    int rounds_to_draw = kSettlingRounds;
    bool sent_stop = false, ended_seen = false, paused_seen = false;
    bool scene_waits = false;  // the last frame was too soon for redrawing the 3D view
};

namespace {

Result<std::unique_ptr<Window>> OpenWindow(const ViewerOptions& options) {
    const std::string title = options.title.empty() ? "Tessera" : options.title + " - Tessera";
    return Window::Open(title, options.width, options.height, options.scale);
}

}  // namespace

Result<std::unique_ptr<Viewer>> Viewer::Open(ViewerLink& link, const ViewerOptions& options) {
    Result<std::unique_ptr<Window>> window = OpenWindow(options);
    if (!window.ok()) return window.status();
    auto impl = std::make_unique<Impl>(std::move(window.value()), &link, options);
    Result<std::unique_ptr<SceneView>> scene =
        SceneView::Create(impl->window->is_software(), CoverageLevels::Of(options.max_weight));
    if (!scene.ok()) return scene.status();
    impl->scene = std::move(scene.value());
    if (options.view_kind == ViewKind::kScan) impl->scene->camera().Zoom(kNearer);
    return std::unique_ptr<Viewer>(new Viewer(std::move(impl)));
}

Result<std::unique_ptr<Viewer>> Viewer::OpenModel(ViewedModel model, const ViewerOptions& options) {
    Result<std::unique_ptr<Window>> window = OpenWindow(options);
    if (!window.ok()) return window.status();
    ViewerOptions with_labels = options;
    with_labels.labelled = !model.mesh.labels.empty();
    auto impl = std::make_unique<Impl>(std::move(window.value()), nullptr, with_labels);
    Result<std::unique_ptr<SceneView>> scene =
        SceneView::Create(impl->window->is_software(), CoverageLevels::Of(options.max_weight));
    if (!scene.ok()) return scene.status();
    impl->scene = std::move(scene.value());
    impl->state.view.follow = false;
    if (model.mesh.colours.empty()) impl->state.view.shading = Shading::kGrey;
    impl->scene->SetModel(model);
    impl->state.system.SetObjects(std::move(model.objects));
    return std::unique_ptr<Viewer>(new Viewer(std::move(impl)));
}

Viewer::Viewer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Viewer::~Viewer() = default;

void Viewer::Run() {
    while (RunOnce()) {
    }
}

bool Viewer::RunOnce() { return impl_->RunOnce(); }

std::optional<ControlRect> Viewer::FindControl(const std::string& name) const {
    return impl_->state.controls.Find(name);
}

ColourImage Viewer::Picture() {
    if (impl_->window->ShouldClose() || impl_->window->is_minimised()) return {};
    for (int i = 0; i < kSettlingRounds; ++i) impl_->DrawFrame(true);
    return impl_->window->Read();
}

double Viewer::Impl::FramePeriodS() const {
    if (state.options.max_fps > 0) return 1 / state.options.max_fps;
    return window->is_software() ? 1.0 / 15 : 1.0 / 60;
}

bool Viewer::Impl::RunOnce() {
    ImGui::GetIO().MouseDoubleClickTime = static_cast<float>(state.options.double_click_s);
    if (window->WaitForInput(state.options.wait_s)) rounds_to_draw = kSettlingRounds;
    const double now_s = state.now_s = clock.ElapsedMs() / 1000;
    ViewerLink* const link = state.link;
    if (link) {
        if (state.system.Take(*link, now_s)) rounds_to_draw = std::max(rounds_to_draw, 1);
        constexpr std::size_t kBytesPerRound = std::size_t{4} << 20;
        if (scene->TakeMesh(*link, kBytesPerRound)) rounds_to_draw = std::max(rounds_to_draw, 1);
        if (state.ended() != ended_seen || state.paused() != paused_seen)
            rounds_to_draw = kSettlingRounds;
        ended_seen = state.ended();
        paused_seen = state.paused();
        // Words about silence, and hints that go.
        if (!ended_seen && now_s - drawn_at_s > kLongest_s)
            rounds_to_draw = std::max(rounds_to_draw, 1);
    }
    for (const Window::Key& key : window->TakeKeys()) {
        if (!ImGui::GetIO().WantTextInput) state.OnKey(key.key, key.mods);
        rounds_to_draw = kSettlingRounds;
    }
    if (scene->Follow(state, std::min(now_s - followed_at_s, 0.2)))
        rounds_to_draw = std::max(rounds_to_draw, 1);
    followed_at_s = now_s;

    if (state.close || window->ShouldClose() ||
        (ended_seen && link && state.options.close_at_end)) {
        if (link && !link->ended && !sent_stop)
            link->commands.Push({ViewerCommand::Kind::kStop, {}});
        sent_stop = true;
        return false;
    }
    if (rounds_to_draw > 0 && now_s - drawn_at_s >= FramePeriodS() && !window->is_minimised()) {
        --rounds_to_draw;
        drawn_at_s = now_s;
        DrawFrame(false);
        window->Show();
    } else if (window->is_software() && scene_waits) {
        rounds_to_draw = std::max(rounds_to_draw, MayRedrawView(now_s) ? 1 : 0);
    }
    if (state.want_screenshot) TakeScreenshot();
    return true;
}

bool Viewer::Impl::MayRedrawView(double now_s) const {
    if (!window->is_software() || state.options.max_fps > 0) return true;
    return now_s - view_drawn_at_s >= std::max(kSoftwareViewPeriodS, view_cost_s / kSoftwareShare);
}

void Viewer::Impl::DrawFrame(bool smooth) {
    const double begin_s = clock.ElapsedMs() / 1000;
    const bool may_redraw = smooth || MayRedrawView(begin_s);
    window->BeginFrame();
    state.controls.BeginFrame();
    const bool drawn = DrawPanels(may_redraw, smooth);
    window->EndFrame();
    scene_waits = !may_redraw;
    if (!drawn) return;
    window->Finish();
    view_drawn_at_s = clock.ElapsedMs() / 1000;
    view_cost_s = view_drawn_at_s - begin_s;
}

bool Viewer::Impl::DrawPanels(bool may_redraw, bool smooth) {
    const bool drawn = state.view_kind == ViewKind::kScan ? DrawScan(may_redraw, smooth)
                                                          : DrawExpert(may_redraw, smooth);
    DrawHelp(state);
    DrawResetQuestion(state);
    return drawn;
}

bool Viewer::Impl::DrawScan(bool may_redraw, bool smooth) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const ScanPanel::Layout layout = ScanPanel::LayOut(size.x, size.y);
    scan.Update(state);
    const bool drawn = DrawViewPanel(state, *scene,
                                     {.area = layout.view,
                                      .inset_width = scan.inset_width(state, layout.view),
                                      .may_redraw = may_redraw,
                                      .smooth = smooth});
    scan.Draw(state, *scene, layout);
    return drawn;
}

bool Viewer::Impl::DrawExpert(bool may_redraw, bool smooth) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const Layout layout = LayOut(size.x, size.y, state.link != nullptr);
    const bool drawn = DrawViewPanel(
        state, *scene, {.area = layout.view, .may_redraw = may_redraw, .smooth = smooth});
    if (!state.link) return drawn;
    {
        const Panel left("left", layout.left);
        DrawStatusPanel(state, *scene);
        DrawControlsPanel(state);
        DrawObjectsPanel(state, *scene);
        DrawMessagesPanel(state);
    }
    images.Draw(state, layout.images);
    DrawPlotsPanel(state, layout.plots);
    return drawn;
}

void Viewer::Impl::TakeScreenshot() {
    state.want_screenshot = false;
    if (window->is_minimised()) return;
    DrawFrame(true);
    const std::string path = state.NewFileName("scan", "png");
    const Status status = WriteColourImage(path, window->Read());
    state.system.Say(status.ok() ? "screenshot saved: " + path : status.message());
    rounds_to_draw = kSettlingRounds;
}

}  // namespace tessera
