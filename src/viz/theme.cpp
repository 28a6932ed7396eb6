#include "viz/theme.h"

#include <filesystem>
#include <string>

namespace tessera {
namespace {

// For the only ImGui context of this process.
struct {
    float scale = 1;
    ImFont *small = nullptr, *heading = nullptr, *title = nullptr;
} theme;

// Uses Debian's fonts-dejavu-core, or ImGui's own font if that is missing.
ImFont* LoadFont(const char* file, float size_px) {
    const std::string path = std::string("/usr/share/fonts/truetype/dejavu/") + file;
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored))
        if (ImFont* font = atlas.AddFontFromFileTTF(path.c_str(), size_px)) return font;
    ImFontConfig config;
    config.SizePixels = size_px;
    return atlas.AddFontDefault(&config);
}

ImVec4 Grey(int level, float alpha = 1) {
    const float base = static_cast<float>(level) / 255;
    return {base * 0.94f, base * 0.98f, base * 1.08f, alpha};
}

void SetColours(ImGuiStyle& style) {
    const ImVec4 accent = ImGui::ColorConvertU32ToFloat4(palette::kAccent);
    const auto faded = [&](float alpha) { return ImVec4(accent.x, accent.y, accent.z, alpha); };
    ImVec4* c = style.Colors;
    c[ImGuiCol_Text] = ImGui::ColorConvertU32ToFloat4(palette::kText);
    c[ImGuiCol_TextDisabled] = ImGui::ColorConvertU32ToFloat4(palette::kDim);
    c[ImGuiCol_WindowBg] = Grey(27);
    c[ImGuiCol_ChildBg] = ImVec4(0, 0, 0, 0);
    c[ImGuiCol_PopupBg] = Grey(33, 0.98f);
    c[ImGuiCol_Border] = ImGui::ColorConvertU32ToFloat4(palette::kLine);
    c[ImGuiCol_FrameBg] = Grey(42);
    c[ImGuiCol_FrameBgHovered] = Grey(54);
    c[ImGuiCol_FrameBgActive] = Grey(62);
    c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgActive] = Grey(36);
    c[ImGuiCol_ScrollbarBg] = ImVec4(0, 0, 0, 0);
    c[ImGuiCol_ScrollbarGrab] = Grey(60);
    c[ImGuiCol_CheckMark] = c[ImGuiCol_SliderGrab] = accent;
    c[ImGuiCol_SliderGrabActive] = Grey(230);
    c[ImGuiCol_Button] = Grey(46);
    c[ImGuiCol_ButtonHovered] = Grey(60);
    c[ImGuiCol_ButtonActive] = faded(0.6f);
    c[ImGuiCol_Header] = faded(0.35f);
    c[ImGuiCol_HeaderHovered] = faded(0.45f);
    c[ImGuiCol_HeaderActive] = faded(0.6f);
    c[ImGuiCol_Separator] = c[ImGuiCol_Border];
    c[ImGuiCol_TableRowBgAlt] = Grey(32);
    c[ImGuiCol_ModalWindowDimBg] = ImVec4(0, 0, 0, 0.55f);
}

}  // namespace

void ApplyTheme(float scale) {
    theme.scale = scale;
    ImGui::GetIO().Fonts->Clear();
    LoadFont("DejaVuSans.ttf", 13.5f * scale);
    theme.small = LoadFont("DejaVuSans.ttf", 11 * scale);
    theme.heading = LoadFont("DejaVuSans-Bold.ttf", 15 * scale);
    theme.title = LoadFont("DejaVuSans-Bold.ttf", 22 * scale);

    ImGuiStyle& style = ImGui::GetStyle();
    style = ImGuiStyle();
    style.WindowPadding = {12, 10};
    style.FramePadding = {8, 4};
    style.ItemSpacing = {8, 6};
    style.ItemInnerSpacing = {6, 4};
    style.WindowRounding = 0;
    style.FrameRounding = style.GrabRounding = style.PopupRounding = 4;
    style.WindowBorderSize = 0;
    style.PopupBorderSize = 1;
    style.ScrollbarSize = 10;
    style.GrabMinSize = 10;
    style.DisabledAlpha = 0.4f;
    SetColours(style);
    style.ScaleAllSizes(scale);
}

float Scaled(float size) { return size * theme.scale; }
ImFont* SmallFont() { return theme.small; }
ImFont* HeadingFont() { return theme.heading; }
ImFont* TitleFont() { return theme.title; }

}  // namespace tessera
