// The controls: settings and commands.
#include <fmt/format.h>

#include <algorithm>

#include "viz/panels.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

float WidthOf(int columns) {
    const float gaps = static_cast<float>(columns - 1) * ImGui::GetStyle().ItemSpacing.x;
    return (ImGui::GetContentRegionAvail().x - gaps) / static_cast<float>(columns);
}

void DrawMethods(ViewerState& state) {
    constexpr int kColumns = 2;
    GroupTitle("TRACKING");
    const float width = WidthOf(kColumns);
    int number = 0;  // the key that selects the method
    for (const TrackingMethodInfo& info : kTrackingMethods) {
        if (number++ % kColumns != 0) ImGui::SameLine();
        const std::string name = fmt::format("method.{}", info.name);
        if (MarkedButton(state.controls, name.c_str(), info.label, width,
                         state.settings.method == info.method))
            state.SelectMethod(info.method);
        Tip(fmt::format("{}  ({})", info.tip, number).c_str());
    }
}

void DrawSettings(ViewerState& state) {
    ViewerSettings& settings = state.settings;
    Controls& controls = state.controls;
    const float label_width = Scaled(88);
    bool changed = false;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("Colour");
    Tip("Weight of the photometric residual relative to the distances, alpha of [B14] eq. 8, in "
        "square metres");
    ImGui::SameLine(label_width);
    changed |= MarkedCheckbox(controls, "alpha.auto", "auto", settings.auto_alpha);
    ImGui::SameLine();
    double shown = settings.auto_alpha ? state.system.frame().report.track.alpha : settings.alpha;
    ImGui::BeginDisabled(settings.auto_alpha);
    if (MarkedSlider(controls, "alpha", shown, 0.0005, 2, "%.4f m\xC2\xB2", true) &&
        !settings.auto_alpha) {
        settings.alpha = shown;
        changed = true;
    }
    ImGui::EndDisabled();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("Max depth");
    Tip("Depth beyond this is ignored");
    ImGui::SameLine(label_width);
    changed |= MarkedSlider(controls, "max_depth", settings.max_depth_m, 0.5, 10, "%.1f m");
    if (ImGui::BeginTable("switches", 3, ImGuiTableFlags_SizingStretchProp)) {
        ImGui::TableNextColumn();
        changed |= MarkedCheckbox(controls, "fusing", "Fuse", settings.fusing);
        Tip("Off: frames are tracked but not fused into the map");
        if (settings.loops) {
            ImGui::TableNextColumn();
            changed |= MarkedCheckbox(controls, "loops", "Loops", *settings.loops);
            Tip("Off: no loop is closed, and a lost camera is not looked for");
        }
        ImGui::TableNextColumn();
        changed |= MarkedCheckbox(controls, "prealign", "Prealign", settings.prealign);
        Tip("Estimate the rotation from small images before tracking; helps with fast motion");
        ImGui::TableNextColumn();
        changed |= MarkedCheckbox(controls, "prediction", "Predict", settings.show_prediction);
        Tip("Show the map's prediction beside the measured images");
        ImGui::TableNextColumn();
        bool raster = settings.prediction == IcpTracker::Prediction::kRaster;
        if (MarkedCheckbox(controls, "raster", "Raster", raster)) state.RasteriseViews(raster);
        Tip("ICP and labels: views drawn by OpenGL from the mesh, [D18], instead of cast rays");
        ImGui::EndTable();
    }
    if (changed) state.SendSettings();
}

void DrawCommands(ViewerState& state) {
    Controls& controls = state.controls;
    GroupTitle("RUN");
    const float narrow = WidthOf(4), wide = WidthOf(3);
    ImGui::BeginDisabled(state.ended());
    if (MarkedButton(controls, "pause", state.paused() ? "Resume" : "Pause", narrow,
                     state.paused()))
        state.TogglePause();
    Tip("Pause or resume  (Space)");
    ImGui::SameLine();
    if (MarkedButton(controls, "step", "Step", narrow)) state.Step();
    Tip("Process one frame, then pause  (S)");
    ImGui::SameLine();
    if (MarkedButton(controls, "reset", "Reset", narrow)) state.ask_reset = true;
    Tip("Start over with an empty map; asks first  (R)");
    ImGui::SameLine();
    if (MarkedButton(controls, "record", state.recording() ? "Stop rec." : "Record", narrow,
                     state.recording()))
        state.ToggleRecording();
    Tip("Record the raw frames from now on  (V)");
    if (MarkedButton(controls, "save_mesh", "Save mesh", wide)) state.SaveMesh();
    Tip("Save the mesh as .ply  (M)");
    ImGui::SameLine();
    if (MarkedButton(controls, "save_scan", "Save scan", wide)) state.SaveScan();
    Tip("Save everything so far, and continuously from now on, to a .scan that can be resumed  "
        "(K)");
    ImGui::SameLine();
    ImGui::EndDisabled();
    if (MarkedButton(controls, "screenshot", "Picture", wide)) state.want_screenshot = true;
    Tip("Save this window as .png  (P)");
}

}  // namespace

void DrawControlsPanel(ViewerState& state) {
    ImGui::BeginDisabled(state.ended());
    DrawMethods(state);
    DrawSettings(state);
    ImGui::EndDisabled();
    DrawCommands(state);
}

void DrawResetQuestion(ViewerState& state) {
    if (!state.ask_reset) return;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::OpenPopup("Reset");
    if (!ImGui::BeginPopupModal("Reset", nullptr,
                                ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoTitleBar))
        return;
    HeadingText("Start over?");
    ImGui::TextUnformatted("This discards the map and the path of this run.");
    ImGui::Dummy({0, Scaled(4)});
    const bool yes = MarkedButton(state.controls, "reset.confirm", "Reset", Scaled(120));
    ImGui::SameLine();
    const bool no = MarkedButton(state.controls, "reset.cancel", "Keep", Scaled(120));
    if (yes) state.Reset();
    if (yes || no) {
        state.ask_reset = false;
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

}  // namespace tessera
