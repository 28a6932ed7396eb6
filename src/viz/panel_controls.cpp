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
                         state.method() == info.method))
            state.SelectMethod(info.method);
        Tip(fmt::format("{}  ({})", info.tip, number).c_str());
    }
}

void DrawSettings(ViewerState& state) {
    ViewerSettings& settings = state.settings;
    Controls& controls = state.controls;
    const float label_width = Scaled(104);
    bool changed = false;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("Colour counts");
    Tip("How much the picture counts against the shape in tracking: alpha of [B14] eq. 8, in "
        "square "
        "metres");
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
    ImGui::TextUnformatted("Largest depth");
    Tip("What is measured farther away than this is ignored");
    ImGui::SameLine(label_width);
    changed |= MarkedSlider(controls, "max_depth", settings.max_depth_m, 0.5, 10, "%.1f m");
    if (ImGui::BeginTable("switches", 2, ImGuiTableFlags_SizingFixedFit)) {
        ImGui::TableNextColumn();
        changed |= MarkedCheckbox(controls, "fusing", "Add to the map", settings.fusing);
        Tip("Off: the camera is tracked, but the map stays as it is");
        if (settings.loops) {
            ImGui::TableNextColumn();
            changed |= MarkedCheckbox(controls, "loops", "Close loops", *settings.loops);
            Tip("On: where the camera comes back to a known place, path and map are corrected, and "
                "a lost "
                "camera is found again");
        }
        ImGui::TableNextColumn();
        changed |= MarkedCheckbox(controls, "prealign", "Align rotation first", settings.prealign);
        Tip("Finds the rotation in small images before tracking; helps when the camera turns fast");
        ImGui::TableNextColumn();
        changed |=
            MarkedCheckbox(controls, "prediction", "Show prediction", settings.show_prediction);
        Tip("The depth that the map predicts, beside the measured images");
        ImGui::TableNextColumn();
        bool raster = settings.prediction == IcpTracker::Prediction::kRaster;
        if (MarkedCheckbox(controls, "raster", "OpenGL views", raster))
            state.RasteriseViews(raster);
        Tip("What ICP and labels compare with is drawn by OpenGL from the mesh, [D18]; off: by "
            "casting "
            "rays into the map");
        ImGui::EndTable();
    }
    if (changed) state.SendSettings();
}

void DrawSaving(ViewerState& state) {
    Controls& controls = state.controls;
    const float width = WidthOf(3);
    ImGui::BeginDisabled(!state.can_save());
    if (MarkedButton(controls, "save_mesh", "Save mesh", width)) state.SaveMesh();
    Tip("Save the mesh as .ply, also after the end  (M)");
    ImGui::SameLine();
    if (MarkedButton(controls, "save_scan", "Save scan", width)) state.SaveScan();
    Tip("Save everything so far, and what comes, to a .scan that can be continued  (K)");
    ImGui::SameLine();
    ImGui::EndDisabled();
    if (MarkedButton(controls, "screenshot", "Picture", width)) state.want_screenshot = true;
    Tip("Save this window as .png  (P)");
}

void DrawCommands(ViewerState& state) {
    Controls& controls = state.controls;
    GroupTitle("RUN");
    const float width = WidthOf(4);
    ImGui::BeginDisabled(state.ended());
    if (MarkedButton(controls, "pause", state.paused() ? "Go on" : "Pause", width, state.paused()))
        state.TogglePause();
    Tip("Pause, or go on  (Space)");
    ImGui::SameLine();
    if (MarkedButton(controls, "step", "Step", width)) state.Step();
    Tip("Process one frame, then pause  (S)");
    ImGui::SameLine();
    if (MarkedButton(controls, "reset", "Reset", width)) state.ask_reset = true;
    Tip("Start over with an empty map; asks first  (R)");
    ImGui::SameLine();
    if (MarkedButton(controls, "record", state.recording() ? "Stop rec." : "Record", width,
                     state.recording()))
        state.ToggleRecording();
    Tip("Record the raw frames from now on  (V)");
    ImGui::EndDisabled();
    DrawSaving(state);
}

}  // namespace

void DrawControlsPanel(ViewerState& state) {
    ImGui::BeginDisabled(state.ended());
    DrawMethods(state);
    DrawSettings(state);
    ImGui::EndDisabled();
    DrawCommands(state);
}

}  // namespace tessera
