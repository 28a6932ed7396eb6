// The detector: its state, which one, what it looks for.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "viz/panels.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

void DrawDetector(const ViewerState& state) {
    const SystemView& system = state.system;
    ImGui::PushFont(SmallFont());
    if (!state.labelled())
        LabelledValue("Detector", "none: choose one below", palette::kDim);
    else if (system.labels().stopped)
        LabelledValue("Detector", "failed: see the messages", palette::kBad);
    else if (system.detections_per_s() <= 0)
        LabelledValue("Detector", state.ended() ? "ended" : "waiting for the first detections",
                      palette::kDim);
    else
        LabelledValue("Detector",
                      fmt::format("{:.1f} images/s, {:.0f} ms each", system.detections_per_s(),
                                  system.labels().detect_ms));
    ImGui::PopFont();
}

// Labelling on and off, and the classes whose detections count.
void DrawLabelSettings(ViewerState& state) {
    if (!state.labelled()) return;
    if (MarkedCheckbox(state.controls, "labelling", "Label objects", state.settings.labels.on))
        state.SendSettings();
    Tip("Off: nothing is detected; labels stay as they are");
    ImGui::SameLine(Scaled(144));
    if (MarkedButton(state.controls, "classes", "Classes", ImGui::GetContentRegionAvail().x))
        ImGui::OpenPopup("classes");
    Tip("The classes that are labelled from now on");
    ImGui::SetNextWindowSizeConstraints({0, 0}, {Scaled(240), Scaled(300)});
    if (ImGui::BeginPopup("classes")) {
        const LabelClasses& classes = state.system.classes();
        for (int id = 1; id <= classes.count(); ++id) {
            bool used = !state.settings.labels.ignored[static_cast<std::size_t>(id)];
            const std::string& name = classes.name(id);
            if (MarkedCheckbox(state.controls, ("class." + name).c_str(), name.c_str(), used))
                state.UseClass(id, used);
        }
        ImGui::EndPopup();
    }
}

void ListModels(ViewerState& state, const std::string& current, std::string& chosen) {
    if (state.options.models.empty())
        SmallText(palette::kDim, "no model file in ./models or beside the one in use");
    for (const std::string& model : state.options.models) {
        const std::string name = std::filesystem::path(model).filename().string();
        if (ImGui::Selectable((name + "##" + model).c_str(), model == current,
                              ImGuiSelectableFlags_DontClosePopups))
            chosen = model;
        state.controls.MarkLast("detector." + name);
        Tip(model.c_str());
    }
}

// The models that were found, and any other file.
void DrawDetectorMenu(ViewerState& state, const std::string& current) {
    if (!ImGui::BeginPopup("detectors")) return;
    std::string chosen;
    ListModels(state, current, chosen);
    ImGui::Dummy({0, Scaled(4)});
    SmallText(palette::kDim, "another file: .onnx, .cfg, .weights or detections");
    ImGui::SetNextItemWidth(Scaled(250));
    const bool entered =
        ImGui::InputText("##path", state.typed_path.data(), state.typed_path.size(),
                         ImGuiInputTextFlags_EnterReturnsTrue);
    state.controls.MarkLast("detector.path");
    ImGui::SameLine();
    if ((MarkedButton(state.controls, "detector.use", "Use", Scaled(60)) || entered) &&
        state.typed_path[0] != 0)
        chosen = state.typed_path.data();
    if (!chosen.empty()) {
        state.UseDetector(chosen);
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

void DrawDetectorChoice(ViewerState& state) {
    const std::string& current = state.detector();
    const std::string name =
        current.empty() ? "Choose a detector" : std::filesystem::path(current).filename().string();
    if (MarkedButton(state.controls, "detector.choose", name.c_str(),
                     ImGui::GetContentRegionAvail().x))
        ImGui::OpenPopup("detectors");
    Tip("The model that finds objects in the pictures. Another one takes over when it is open.");
    DrawDetectorMenu(state, current);
}

}  // namespace

void DrawDetectorPanel(ViewerState& state) {
    DrawDetector(state);
    state.controls.MarkLast("detector");
    if (state.link == nullptr) return;
    ImGui::BeginDisabled(state.ended());
    DrawDetectorChoice(state);
    DrawLabelSettings(state);
    ImGui::EndDisabled();
}

}  // namespace tessera
