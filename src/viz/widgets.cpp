#include "viz/widgets.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/printf.h>

namespace tessera {

void Controls::MarkLast(const std::string& name) {
    const ImVec2 from = ImGui::GetItemRectMin(), size = ImGui::GetItemRectSize();
    Mark(name, {from.x, from.y, size.x, size.y});
}

Panel::Panel(const char* name, const ControlRect& area, ImGuiWindowFlags more) {
    ImGui::SetNextWindowPos({area.x, area.y});
    ImGui::SetNextWindowSize({area.width, area.height});
    ImGui::Begin(name, nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                     ImGuiWindowFlags_NoNav | more);
}

Panel::~Panel() { ImGui::End(); }

void SmallText(ImU32 colour, const std::string& text) {
    ImGui::PushFont(SmallFont());
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopStyleColor();
    ImGui::PopFont();
}

void HeadingText(const char* text) {
    ImGui::PushFont(HeadingFont());
    ImGui::TextUnformatted(text);
    ImGui::PopFont();
}

void GroupTitle(const char* text) {
    ImGui::Dummy({0, Scaled(4)});
    SmallText(palette::kDim, text);
    ImGui::SameLine();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float y = at.y + 0.55f * ImGui::GetTextLineHeight();
    ImGui::GetWindowDrawList()->AddLine({at.x, y}, {at.x + ImGui::GetContentRegionAvail().x, y},
                                        palette::kLine);
    ImGui::NewLine();
}

void LabelledValue(const char* label, const std::string& value, ImU32 colour) {
    ImGui::PushStyleColor(ImGuiCol_Text, palette::kDim);
    ImGui::TextUnformatted(label);
    ImGui::PopStyleColor();
    const float width = ImGui::CalcTextSize(value.c_str()).x;
    ImGui::SameLine(0, 0);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - width);
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    ImGui::TextUnformatted(value.c_str());
    ImGui::PopStyleColor();
}

std::string FittedText(const std::string& text, float width) {
    if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
    std::string fitted = "...";
    for (std::size_t begin = 1; begin < text.size(); ++begin) {
        if ((static_cast<unsigned char>(text[begin]) & 0xC0) == 0x80)
            continue;  // within a character
        fitted = "..." + text.substr(begin);
        if (ImGui::CalcTextSize(fitted.c_str()).x <= width) break;
    }
    return fitted;
}

void Tip(const char* text) {
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", text);
}

bool TakesKey(int key) {
    if (!ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) return ImGui::GetIO().WantTextInput;
    if (key == GLFW_KEY_ESCAPE) ImGui::SetWindowFocus(nullptr);  // closes menus
    return true;
}

ImU32 ColourOf(QualityLevel level) {
    switch (level) {
        case QualityLevel::kIdle: return palette::kIdle;
        case QualityLevel::kGood: return palette::kGood;
        case QualityLevel::kWarning: return palette::kWarning;
        case QualityLevel::kBad: return palette::kBad;
    }
    return palette::kIdle;
}

void DrawLamp(ImDrawList& list, const ImVec2& centre, ImU32 colour) {
    const ImU32 halo = (colour & ~IM_COL32_A_MASK) | (60u << IM_COL32_A_SHIFT);
    list.AddCircleFilled(centre, Scaled(11), halo);
    list.AddCircleFilled(centre, Scaled(6.5f), colour);
}

bool MarkedButton(Controls& controls, const char* name, const char* label, float width, bool lit,
                  float height) {
    if (lit) {
        ImGui::PushStyleColor(ImGuiCol_Button, palette::kLit);
        ImGui::PushStyleColor(ImGuiCol_ButtonHovered, palette::kLit);
    }
    ImGui::PushID(name);
    const bool pressed = ImGui::Button(label, {width, height});
    ImGui::PopID();
    if (lit) ImGui::PopStyleColor(2);
    controls.MarkLast(name);
    return pressed;
}

bool MarkedCheckbox(Controls& controls, const char* name, const char* label, bool& value) {
    ImGui::PushID(name);
    const bool changed = ImGui::Checkbox(label, &value);
    ImGui::PopID();
    controls.MarkLast(name);
    return changed;
}

bool MarkedSlider(Controls& controls, const char* name, double& value, double least, double most,
                  const char* format, bool logarithmic) {
    ImGui::PushID(name);
    const float value_width = Scaled(72),
                right = ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x;
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - value_width);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {Scaled(4), Scaled(2)});
    const ImVec2 text_at{0, ImGui::GetCursorPosY()};
    ImGui::SetCursorPosY(text_at.y + Scaled(2));
    const bool changed =
        ImGui::SliderScalar("##value", ImGuiDataType_Double, &value, &least, &most, "",
                            ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput |
                                (logarithmic ? ImGuiSliderFlags_Logarithmic : 0));
    ImGui::PopStyleVar();
    controls.MarkLast(name);
    const std::string text = fmt::sprintf(format, value);
    ImGui::SameLine(0, 0);
    ImGui::SetCursorPos({right - ImGui::CalcTextSize(text.c_str()).x, text_at.y});
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopID();
    return changed;
}

}  // namespace tessera
