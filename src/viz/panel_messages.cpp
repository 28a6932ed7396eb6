// The list of messages, scrolled to the newest at the bottom.
#include "viz/panels.h"
#include "viz/widgets.h"

namespace tessera {

void DrawMessagesPanel(const ViewerState& state) {
    GroupTitle("MESSAGES");
    ImGui::BeginChild("lines", {0, 0}, false, ImGuiWindowFlags_NoNav);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, Scaled(3)});
    const auto& messages = state.system.messages();
    if (messages.empty()) SmallText(palette::kIdle, "no messages yet");
    ImGui::PushTextWrapPos(0);
    for (std::size_t i = 0; i < messages.size(); ++i)
        SmallText(i + 1 == messages.size() ? palette::kText : palette::kDim, messages[i]);
    ImGui::PopTextWrapPos();
    // Unless the user has scrolled up.
    if (ImGui::GetScrollY() >= ImGui::GetScrollMaxY() - Scaled(20)) ImGui::SetScrollHereY(1);
    ImGui::PopStyleVar();
    ImGui::EndChild();
}

}  // namespace tessera
