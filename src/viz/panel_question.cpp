// The question before a reset. While it is on screen it holds the mouse, and ViewerState the keys.
#include "viz/panels.h"
#include "viz/widgets.h"

namespace tessera {

void DrawResetQuestion(ViewerState& state) {
    if (!state.ask_reset) {  // perhaps answered by a key: what is left open would take all others
        if (ImGui::IsPopupOpen("Reset")) ImGui::SetWindowFocus(nullptr);
        return;
    }
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::OpenPopup("Reset");
    if (!ImGui::BeginPopupModal("Reset", nullptr,
                                ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoTitleBar))
        return;
    HeadingText("Start anew?");
    ImGui::TextUnformatted("This discards the map and the path of this run.");
    SmallText(palette::kDim, "Enter: start anew    Escape: keep");
    ImGui::Dummy({0, Scaled(4)});
    const bool yes = MarkedButton(state.controls, "reset.confirm", "Start anew", Scaled(120));
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
