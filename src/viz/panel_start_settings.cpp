// How to scan: the settings of the start screen.
#include <fmt/format.h>

#include <filesystem>

#include "core/printable.h"
#include "viz/start_state.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

void DrawWrapped(ImU32 colour, const std::string& text) {
    ImGui::PushTextWrapPos(0);
    SmallText(colour, text);
    ImGui::PopTextWrapPos();
}

void DrawQuality(StartState& state) {
    GroupTitle("QUALITY");
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const float width = (ImGui::GetContentRegionAvail().x - 2 * gap) / 3;
    for (const QualityInfo& info : StartQualities()) {
        if (info.quality != StartQuality::kFast) ImGui::SameLine();
        if (MarkedButton(state.controls, fmt::format("quality.{}", info.name).c_str(), info.label,
                         width, state.choices.quality == info.quality)) {
            state.choices.quality = info.quality;
            state.Changed();
        }
    }
    DrawWrapped(palette::kDim, InfoOf(state.choices.quality).cost);
}

void DrawLoops(StartState& state) {
    GroupTitle("LOOPS");
    if (MarkedCheckbox(state.controls, "loops", "Close loops", state.choices.loops))
        state.Changed();
    DrawWrapped(palette::kDim,
                "Where the camera comes back to a known place, path and surface are corrected.");
}

void DrawLabels(StartState& state) {
    GroupTitle("LABELS");
    const auto name_of = [](const std::string& model) {
        return model.empty() ? std::string("None")
                             : Printable(std::filesystem::path(model).filename().string());
    };
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
    ImGui::BeginDisabled(state.services.models.empty());
    const bool open = ImGui::BeginCombo("##labels", name_of(state.choices.labels).c_str());
    state.controls.MarkLast("labels");
    if (open) {
        std::vector<std::string> models = state.services.models;
        models.insert(models.begin(), "");
        for (const std::string& model : models) {
            if (ImGui::Selectable((name_of(model) + "##" + model).c_str(),
                                  model == state.choices.labels)) {
                state.choices.labels = model;
                state.Changed();
            }
            state.controls.MarkLast("labels." + name_of(model));
        }
        ImGui::EndCombo();
    }
    ImGui::EndDisabled();
    DrawWrapped(palette::kDim, state.services.models.empty()
                                   ? "There is no detection network in ./models (see "
                                     "docs/labels.md)."
                                   : "A detection network finds objects and names them.");
}

void DrawOutput(StartState& state) {
    GroupTitle("RESULTS");
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
    if (ImGui::InputTextWithHint("##output", "folder for the results", state.typed_output.data(),
                                 state.typed_output.size()))
        state.Changed();
    state.controls.MarkLast("output");
    switch (state.earlier_run()) {
        case StartState::EarlierRun::kNone:
            return DrawWrapped(palette::kDim,
                               "A folder for the surface, the path and the figures.");
        case StartState::EarlierRun::kReplaced:
            return DrawWrapped(palette::kWarning,
                               "This folder holds a run, which will be replaced.");
        case StartState::EarlierRun::kKept:
            return DrawWrapped(palette::kWarning,
                               "This folder holds a camera's run. It is kept: its results will be "
                               "moved to earlier_1, or the next free number, inside.");
    }
}

}  // namespace

void DrawStartSettings(StartState& state) {
    const PathFinding found = state.finding();
    if (found.can_view && !found.can_run)
        return DrawWrapped(palette::kDim, "This is finished: Open shows it, with nothing to set.");
    DrawQuality(state);
    DrawLoops(state);
    DrawLabels(state);
    DrawOutput(state);
}

}  // namespace tessera
