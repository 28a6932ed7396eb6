// The panel of the tools that are on: measuring, cutting, finishing.
#include "viz/panels.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

void CutTool(ViewerState& state, SceneView& scene) {
    ViewChoices& view = state.view;
    GroupTitle("CUT");
    if (MarkedButton(state.controls, "cut.above", "From above", Scaled(100),
                     view.cut == Cut::kAbove))
        view.cut = Cut::kAbove;
    Tip("Hide what is higher");
    ImGui::SameLine();
    if (MarkedButton(state.controls, "cut.front", "From the front", Scaled(110),
                     view.cut == Cut::kFront)) {
        view.cut = Cut::kFront;
        view.cut_towards = scene.camera().LevelDirection();
    }
    Tip("Hide what is nearer, seen from where you are now");
    ImGui::SetNextItemWidth(Scaled(220));
    MarkedSlider(state.controls, "cut.at", view.cut_at, 0, 1, "");
}

void WrappedText(ImU32 colour, const std::string& text) {
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + Scaled(300));
    SmallText(colour, text);
    ImGui::PopTextWrapPos();
}

void FinishTool(ViewerState& state) {
    BackgroundJob& job = state.finishing;
    GroupTitle("FINISH");
    if (job.state() == BackgroundJob::State::kRunning) {
        SmallText(palette::kText, *job.step() ? job.step() : "reading");
        ImGui::ProgressBar(static_cast<float>(job.share()), {Scaled(220), 0});
        state.controls.MarkLast("finish.running");
        ImGui::SameLine();
        if (MarkedButton(state.controls, "finish.cancel", "Cancel", Scaled(70))) job.Cancel();
        return;
    }
    const bool failed = job.state() == BackgroundJob::State::kFailed;
    WrappedText(failed ? palette::kBad : palette::kText,
                job.state() == BackgroundJob::State::kCancelled ? "cancelled" : job.text());
    if (MarkedButton(state.controls, failed ? "finish.failed" : "finish.done", "Close", Scaled(70)))
        job.Dismiss();
}

}  // namespace

void DrawTools(ViewerState& state, SceneView& scene, const ControlRect& area) {
    const bool cuts = state.view.cut != Cut::kNone,
               finishes = state.finishing.state() != BackgroundJob::State::kNone;
    if (!state.measuring.on() && !cuts && !finishes) return;
    ImGui::SetNextWindowPos({area.x + area.width - Scaled(10), area.y + Scaled(76)},
                            ImGuiCond_Always, {1, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, Scaled(6));
    ImGui::Begin("tools", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_NoFocusOnAppearing);
    if (state.measuring.on()) DrawMeasureTool(state);
    if (cuts) CutTool(state, scene);
    if (finishes) FinishTool(state);
    const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    state.controls.Mark("tools", {at.x, at.y, size.x, size.y});
    ImGui::End();
    ImGui::PopStyleVar();
}

}  // namespace tessera
