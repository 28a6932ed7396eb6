// The list of keys and mouse actions.
#include "viz/panels.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

struct Line {
    const char *keys, *meaning;
    bool of_a_run = false;     // not shown for a finished mesh
    bool of_a_replay = false;  // shown with a time line only
};

constexpr Line kLines[] = {
    {"Drag", "rotate the view around the point of interest"},
    {"Shift or middle drag", "move the view"},
    {"Wheel", "zoom in and out"},
    {"Double click", "centre the view on this point"},
    {"Tab", "scan view or expert view", true},
    {"Left, Right", "a frame back or on; with Shift ten", false, true},
    {"Home, End", "the first or the last frame", false, true},
    {"Space", "play or pause", false, true},
    {"F", "stay with the camera on/off", true},
    {"F", "stay with the camera on/off", false, true},
    {"E", "first person on/off: drag looks around, the wheel walks"},
    {"A", "show all of the mesh"},
    {"C", "the next shading; in the scan view: coverage on/off"},
    {"W", "wireframe on/off"},
    {"D", "see through surfaces on/off"},
    {"B", "object boxes and names on/off"},
    {"X", "cut: hide a part of the surface on/off"},
    {"L", "measure by clicks on/off, once the final mesh is there"},
    {"Enter", "measuring: the next click begins anew"},
    {"Backspace", "measuring: take the last click back"},
    {"G", "finish: make a clean, textured model of a finished run"},
    {"T", "true path on/off", true},
    {"I", "scan view: the camera's image on/off", true},
    {"", "", true},
    {"Space", "pause or resume", true},
    {"S", "process one frame, then pause", true},
    {"R", "reset (asks first)", true},
    {"1 2 ...", "tracking method, in the order of the buttons", true},
    {"M", "save the mesh, also after the end", true},
    {"K", "save the scan, also after the end", true},
    {"V", "start or stop recording raw frames", true},
    {"P", "screenshot of this window"},
    {"H or F1", "this help"},
    {"Q or Escape", "close; a running scan stops and is saved"},
};

}  // namespace

void DrawHelp(ViewerState& state) {
    if (!state.show_help) return;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, Scaled(8));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {Scaled(20), Scaled(16)});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ImGui::GetStyleColorVec4(ImGuiCol_PopupBg));
    ImGui::Begin("help", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav);
    HeadingText("Keys and mouse");
    ImGui::Dummy({0, Scaled(2)});
    if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
        for (const Line& line : kLines) {
            if ((line.of_a_run && !state.link) || (line.of_a_replay && !state.replay)) continue;
            ImGui::TableNextColumn();
            ImGui::PushStyleColor(ImGuiCol_Text, palette::kAccent);
            ImGui::TextUnformatted(line.keys);
            ImGui::PopStyleColor();
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(line.meaning);
        }
        ImGui::EndTable();
    }
    ImGui::Dummy({0, Scaled(4)});
    if (MarkedButton(state.controls, "help.close", "Close", Scaled(100))) state.show_help = false;
    const ImVec2 at = ImGui::GetWindowPos(), extent = ImGui::GetWindowSize();
    state.controls.Mark("help.panel", {at.x, at.y, extent.x, extent.y});
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(2);
}

}  // namespace tessera
