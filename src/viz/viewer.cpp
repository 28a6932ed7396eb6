#include "viz/viewer.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "core/stopwatch.h"
#include "io/image_io.h"
#include "viz/expert_layout.h"
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

}  // namespace

// Members are destroyed in reverse order: the window with its context last.
struct Viewer::Impl {
    Impl(std::shared_ptr<Window> opened, ViewerLink* link, const ViewerOptions& options)
        : window(std::move(opened)), state(link, options) {}

    static Result<std::unique_ptr<Impl>> Make(ViewerLink* link, const ViewerOptions& options);
    bool RunOnce();
    void TakeFromLink(ViewerLink& link);
    void DrawAtLeast(int rounds) { rounds_to_draw = std::max(rounds_to_draw, rounds); }
    void DrawFrame(bool smooth);
    bool DrawPanels(bool may_redraw, bool smooth);
    bool DrawScan(bool may_redraw, bool smooth);
    bool DrawExpert(bool may_redraw, bool smooth);
    bool MayRedrawView(double now_s) const;
    void TakeScreenshot();
    double FramePeriodS() const;

    std::shared_ptr<Window> window;
    ViewerState state;
    std::unique_ptr<SceneView> scene;
    ImagesPanel images;
    ScanPanel scan;
    TimeLinePanel time_line;
    Stopwatch clock;
    double drawn_at_s = -1e9, view_drawn_at_s = -1e9, view_cost_s = 0, before_s = 0;
    int rounds_to_draw = kSettlingRounds;
    bool sent_stop = false, ended_seen = false, paused_seen = false;
    bool scene_waits = false;  // the last frame was too soon for redrawing the 3D view
};

Result<std::unique_ptr<Viewer::Impl>> Viewer::Impl::Make(ViewerLink* link,
                                                         const ViewerOptions& options) {
    const std::string title = options.title.empty() ? "Tessera" : options.title + " - Tessera";
    Result<std::shared_ptr<Window>> window = Window::OpenOrKeep(
        options.window, title, options.screen.width, options.screen.height, options.screen.scale);
    if (!window.ok()) return window.status();
    auto impl = std::make_unique<Impl>(std::move(window.value()), link, options);
    Result<std::unique_ptr<SceneView>> scene =
        SceneView::Create(impl->window->is_software(), CoverageLevels::Of(options.max_weight));
    if (!scene.ok()) return scene.status();
    impl->scene = std::move(scene.value());
    return impl;
}

Result<std::unique_ptr<Viewer>> Viewer::Open(ViewerLink& link, const ViewerOptions& options) {
    Result<std::unique_ptr<Impl>> impl = Impl::Make(&link, options);
    if (!impl.ok()) return impl.status();
    if (options.view_kind == ViewKind::kScan) impl.value()->scene->camera().Zoom(kNearer);
    return std::unique_ptr<Viewer>(new Viewer(std::move(impl.value())));
}

Result<std::unique_ptr<Viewer>> Viewer::OpenModel(ViewedModel model, const ViewerOptions& options) {
    ViewerOptions with_labels = options;
    with_labels.labelled = !model.mesh.labels.empty();
    Result<std::unique_ptr<Impl>> made = Impl::Make(nullptr, with_labels);
    if (!made.ok()) return made.status();
    Impl& impl = *made.value();
    impl.state.view.follow = false;
    if (model.mesh.colours.empty()) impl.state.view.shading = Shading::kGrey;
    impl.scene->SetModel(model);
    impl.state.ReadMeasurementsOnce();
    impl.state.finishing.Offer(std::move(model.finish));
    impl.state.system.SetObjects(std::move(model.objects));
    if (model.time_line) {
        impl.state.replay.emplace(std::move(*model.time_line));
        impl.time_line.Begin(std::move(model.open_source));
    }
    return std::unique_ptr<Viewer>(new Viewer(std::move(made.value())));
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

void Viewer::Impl::TakeFromLink(ViewerLink& link) {
    if (state.system.Take(link, state.now_s)) DrawAtLeast(1);
    constexpr std::size_t kBytesPerRound = std::size_t{4} << 20;
    if (scene->TakeMesh(link, kBytesPerRound)) DrawAtLeast(1);
    state.has_final_mesh = scene->has_final_mesh();
    if (state.ended() != ended_seen || state.paused() != paused_seen) DrawAtLeast(kSettlingRounds);
    ended_seen = state.ended();
    paused_seen = state.paused();
    // Words about silence, and hints that go.
    if (!ended_seen && state.now_s - drawn_at_s > kLongest_s) DrawAtLeast(1);
}

bool Viewer::Impl::RunOnce() {
    ImGui::GetIO().MouseDoubleClickTime = static_cast<float>(state.options.screen.double_click_s);
    if (window->WaitForInput(state.options.screen.wait_s)) rounds_to_draw = kSettlingRounds;
    const double now_s = state.now_s = clock.ElapsedMs() / 1000;
    ViewerLink* const link = state.link;
    const double since_s = std::min(now_s - before_s, 1.0);
    before_s = now_s;
    if (link) TakeFromLink(*link);
    if (state.replay && state.replay->Advance(since_s)) DrawAtLeast(1);
    const bool has_image = time_line.Update(state), notes = state.UpdateNote();
    if (state.finishing.Update() || has_image || notes) DrawAtLeast(1);
    for (const Window::Key& key : window->TakeKeys()) {
        if (state.asks() || !TakesKey(key.key)) state.OnKey(key.key, key.mods);
        rounds_to_draw = kSettlingRounds;
    }
    if (scene->Follow(state, std::min(since_s, 0.2))) DrawAtLeast(1);

    if (state.close || window->ShouldClose() ||
        (ended_seen && link && state.options.close_at_end)) {
        if (link && !link->ended && !sent_stop)
            link->commands.Push({ViewerCommand::Kind::kStop, {}});
        sent_stop = true;
        window->SetShown(false);
        return false;
    }
    if (rounds_to_draw > 0 && now_s - drawn_at_s >= FramePeriodS() && !window->is_minimised()) {
        --rounds_to_draw;
        drawn_at_s = now_s;
        DrawFrame(false);
        window->Show();
    } else if (window->is_software() && scene_waits) {
        DrawAtLeast(MayRedrawView(now_s) ? 1 : 0);
    }
    if (state.want_screenshot) TakeScreenshot();
    return true;
}

bool Viewer::Impl::MayRedrawView(double now_s) const {
    if (!window->is_software() || state.options.max_fps > 0 || !state.link) return true;
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
    const ExpertLayout layout = LayOutExpert(size.x, size.y, state.link != nullptr,
                                             state.replay ? TimeLinePanel::Height() : 0);
    const bool drawn =
        DrawViewPanel(state, *scene,
                      {.area = layout.view,
                       .inset_width = state.replay ? time_line.inset_width(state, layout.view) : 0,
                       .may_redraw = may_redraw,
                       .smooth = smooth});
    if (state.replay) time_line.Draw(state, *scene, layout.time_line, layout.view);
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
