// The scan view: one line about quality, advice, what the camera sees, and a few large buttons.
#include <fmt/format.h>

#include <algorithm>

#include "viz/colour_map.h"
#include "viz/panels.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

constexpr float kButtonHeight = 40;

void DrawStrip(ViewerState& state, const SceneView& scene, const ControlRect& area) {
    const Panel panel("strip", area, ImGuiWindowFlags_NoScrollWithMouse);
    const Quality quality = state.quality();
    const ImU32 colour = ColourOf(quality.level);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float middle = area.y + area.height / 2;
    DrawLamp(list, {area.x + Scaled(24), middle}, colour);
    ImFont *const bold = HeadingFont(), *const plain = ImGui::GetFont();
    const ImVec2 title_at{area.x + Scaled(46), middle - 0.55f * bold->FontSize};
    list.AddText(bold, bold->FontSize, title_at, palette::kText, quality.title.c_str());
    const float title_width = bold->CalcTextSizeA(bold->FontSize, 1e4f, 0, quality.title.c_str()).x;
    const std::string fact =
        scene.triangles() == 0
            ? ""
            : fmt::format("{:.0f} % well measured", 100 * scene.coverage().well_share());
    const float fact_width = plain->CalcTextSizeA(plain->FontSize, 1e4f, 0, fact.c_str()).x;
    const float text_y = middle - 0.55f * plain->FontSize;
    const float fact_x = area.x + area.width - fact_width - Scaled(16);
    list.AddText(plain, plain->FontSize, {fact_x, text_y}, palette::kDim, fact.c_str());
    const float reason_x = title_at.x + title_width + Scaled(14);
    const ImVec4 clip{reason_x, area.y, fact_x - Scaled(12), area.y + area.height};
    list.AddText(plain, plain->FontSize, {reason_x, text_y}, palette::kDim, quality.reason.c_str(),
                 nullptr, 0, &clip);
    ImGui::Dummy({area.width - 2 * ImGui::GetStyle().WindowPadding.x, Scaled(20)});
    Tip((quality.title + ": " + quality.reason).c_str());
    state.controls.Mark("status", area);
}

void DrawSaveMenu(ViewerState& state) {
    if (!ImGui::BeginPopup("save")) return;
    const float width = Scaled(250);
    ImGui::BeginDisabled(!state.can_save());
    const bool mesh = MarkedButton(state.controls, "save_mesh", "The model (.ply)", width);
    Tip("A mesh with colours, for other programs  (M)");
    const bool scan =
        MarkedButton(state.controls, "save_scan", "The scan, to continue later (.scan)", width);
    Tip("Everything so far, and from then on  (K)");
    ImGui::EndDisabled();
    const bool picture = MarkedButton(state.controls, "screenshot", "A picture (.png)", width);
    Tip("Of this window  (P)");
    if (mesh) state.SaveMesh();
    if (scan) state.SaveScan();
    if (picture) state.want_screenshot = true;
    if (mesh || scan || picture) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

void DrawRunButtons(ViewerState& state, float width) {
    Controls& controls = state.controls;
    ImGui::BeginDisabled(state.ended());
    const char* label = state.ended() ? "Finished" : state.paused() ? "Go on" : "Pause";
    if (MarkedButton(controls, "pause", label, width, state.paused(), Scaled(kButtonHeight)))
        state.TogglePause();
    Tip("Pause, or go on  (Space)");
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (MarkedButton(controls, "save", "Save", width, false, Scaled(kButtonHeight)))
        ImGui::OpenPopup("save");
    Tip("Save the model, the scan or a picture");
    DrawSaveMenu(state);
    ImGui::SameLine();
    ImGui::BeginDisabled(state.ended());
    if (MarkedButton(controls, "reset", "Start anew", width, false, Scaled(kButtonHeight)))
        state.ask_reset = true;
    Tip("Start over with an empty map; asks first  (R)");
    ImGui::EndDisabled();
}

void DrawViewButtons(ViewerState& state, float width) {
    Controls& controls = state.controls;
    ViewChoices& view = state.view;
    const auto button = [&](const char* name, const char* label, bool lit, const char* tip) {
        const bool pressed = MarkedButton(controls, name, label, width, lit, Scaled(kButtonHeight));
        Tip(tip);
        ImGui::SameLine();
        return pressed;
    };
    if (button("coverage", "Coverage", view.coverage,
               "Where to scan again: red is seen once, orange is thin  (C)"))
        view.coverage = !view.coverage;
    if (button("follow", "Follow", view.follow, "Stay with the camera  (F)")) state.ToggleFollow();
    if (button("first_person", "Own eyes", view.first_person,
               "See the model from where the camera is  (E)"))
        state.ToggleFirstPerson();
    if (button("view_all", "Whole", view.keep_all, "See all of the model  (A)")) state.ViewAll();
    if (button("switch_view", "Expert", false, "Instruments and all settings  (Tab)"))
        state.SwitchView();
    if (button("help", "Help", state.show_help, "Keys and mouse  (H)"))
        state.show_help = !state.show_help;
}

void DrawBar(ViewerState& state, const ControlRect& area) {
    const Panel panel("bar", area, ImGuiWindowFlags_NoScrollWithMouse);
    constexpr int kButtons = 9;
    const float gap = ImGui::GetStyle().ItemSpacing.x, room = ImGui::GetContentRegionAvail().x;
    const float width =
        std::min(Scaled(118), (room - static_cast<float>(kButtons + 1) * gap) / kButtons);
    DrawRunButtons(state, width);
    // At the right edge.
    ImGui::SameLine();
    const float right = 6 * width + 5 * gap;
    ImGui::SetCursorPosX(ImGui::GetStyle().WindowPadding.x + room - right);
    DrawViewButtons(state, width);
}

// The advice, large, at the top of the 3D view.
void DrawBanner(ViewerState& state, const std::string& text, const ControlRect& area) {
    if (text.empty()) return;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImFont* const font = HeadingFont();
    const float size = 1.2f * font->FontSize, pad = Scaled(12), room = area.width - 6 * pad;
    const ImVec2 extent = font->CalcTextSizeA(size, room, room, text.c_str());
    const ImVec2 from{area.x + (area.width - extent.x) / 2 - pad, area.y + Scaled(14)};
    const ImVec2 to{from.x + extent.x + 2 * pad, from.y + extent.y + 1.4f * pad};
    list.AddRectFilled(from, to, IM_COL32(14, 16, 19, 215), Scaled(8));
    list.AddRect(from, to, palette::kWarning, Scaled(8), 0, Scaled(1.5f));
    list.AddText(font, size, {from.x + pad, from.y + 0.7f * pad}, palette::kText, text.c_str(),
                 nullptr, room);
    state.controls.Mark("hint", {from.x, from.y, to.x - from.x, to.y - from.y});
}

}  // namespace

ScanPanel::Layout ScanPanel::LayOut(float width, float height) {
    const float strip = Scaled(44), bar = Scaled(60);
    const float view = std::max(height - strip - bar, 1.0f);
    return {.strip = {0, 0, width, strip},
            .view = {0, strip, width, view},
            .bar = {0, strip + view, width, bar}};
}

float InsetWidth(const ViewerState& state, const GlTexture& image, const ControlRect& view) {
    if (!state.view.camera_image || image.empty()) return 0;
    return std::min(Scaled(232), 0.26f * view.width) + Scaled(12);
}

void DrawInset(ViewerState& state, const GlTexture& image, const ControlRect& view) {
    const float width = InsetWidth(state, image, view) - Scaled(12);
    if (width <= 0) return;
    const float height =
        width * static_cast<float>(image.height()) / static_cast<float>(std::max(image.width(), 1));
    const ImVec2 to{view.x + view.width - Scaled(12), view.y + view.height - Scaled(12)};
    const ImVec2 from{to.x - width, to.y - height};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddImageRounded(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(image.name())),
                         from, to, {0, 0}, {1, 1}, IM_COL32_WHITE, Scaled(6));
    list.AddRect(from, to, IM_COL32(255, 255, 255, 70), Scaled(6), 0, Scaled(1));
    state.controls.Mark("camera_image", {from.x, from.y, width, height});
}

float ScanPanel::inset_width(const ViewerState& state, const ControlRect& view) const {
    return state.ended() ? 0 : InsetWidth(state, colour_, view);
}

void ScanPanel::Update(const ViewerState& state) {
    if (taken_ == state.system.images_taken() || !state.system.images().frame) return;
    taken_ = state.system.images_taken();
    const Frame& frame = *state.system.images().frame;
    depth_ = SharesOf(frame.depth_m, state.settings.max_depth_m);
    constexpr int kWidth_px = 320;
    const int step = std::max(1, (frame.depth_m.width() + kWidth_px - 1) / kWidth_px);
    colour_.Set(
        frame.colour.empty()
            ? DepthColours(frame.depth_m, static_cast<float>(state.settings.max_depth_m), step)
            : ShrinkColour(frame.colour, step));
}

std::optional<ScanHint> ScanPanel::Hint(const ViewerState& state, const SceneView& scene) const {
    const FrameUpdate& frame = state.system.frame();
    const RecentFrames& recent = state.system.recent();
    return HintFor({.status = frame.report.track.status,
                    .degenerate = frame.report.track.degenerate,
                    .speed_m_s = recent.speed_m_s(),
                    .turn_rad_s = recent.turn_rad_s(),
                    .focal_px = state.options.camera.fx,
                    .width_px = state.options.camera.width,
                    .depth = depth_,
                    .max_depth_m = state.settings.max_depth_m,
                    .thin_share = scene.coverage().thin_share(),
                    .frames = frame.counts.frames});
}

void ScanPanel::Draw(ViewerState& state, const SceneView& scene, const Layout& layout) {
    DrawStrip(state, scene, layout.strip);
    DrawBar(state, layout.bar);
    if (state.asks() || state.show_help) return;
    const Panel view("view", layout.view, ImGuiWindowFlags_NoScrollWithMouse);  // adds to it
    if (!state.ended()) DrawInset(state, colour_, layout.view);
    if (!state.system.has_frame() || state.ended() || state.paused())
        holder_ = {};  // no advice for a camera that is not used
    else
        DrawBanner(state, holder_.Update(Hint(state, scene), state.now_s), layout.view);
}

}  // namespace tessera
