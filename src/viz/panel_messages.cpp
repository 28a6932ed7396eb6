// The list of messages, scrolled to the newest at the bottom; and the newest one alone, where there
// is no list.
#include <algorithm>

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

void DrawNote(ViewerState& state, const ControlRect& area, float inset_width) {
    const std::string* const text = state.note();
    if (text == nullptr) return;
    ImFont* const font = ImGui::GetFont();
    const float pad = Scaled(10), side = std::max(inset_width, Scaled(190)) + 2 * pad;
    const float room = std::max(area.width - 2 * side, Scaled(160));
    const ImVec2 extent = font->CalcTextSizeA(font->FontSize, room, room, text->c_str());
    const ImVec2 to{area.x + (area.width + extent.x) / 2 + pad, area.y + area.height - Scaled(14)};
    const ImVec2 from{to.x - extent.x - 2 * pad, to.y - extent.y - 1.4f * pad};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(from, to, IM_COL32(14, 16, 19, 215), Scaled(6));
    list.AddText(font, font->FontSize, {from.x + pad, from.y + 0.7f * pad}, palette::kText,
                 text->c_str(), nullptr, room);
    state.controls.Mark("message", {from.x, from.y, to.x - from.x, to.y - from.y});
}

}  // namespace tessera
