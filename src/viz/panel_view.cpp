// The 3D view: its picture, mouse control and toolbar.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "viz/colour_map.h"
#include "viz/legend.h"
#include "viz/panels.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

// Rotates, pans and zooms with the mouse. A drag stops following the sensor. True if the mouse
// changed the view.
bool HandlePointer(ViewerState& state, SceneView& scene, const ControlRect& area) {
    const ImGuiIO& io = ImGui::GetIO();
    ViewCamera& camera = scene.camera();
    const bool hovered = ImGui::IsItemHovered();
    const bool left = ImGui::IsItemActive() && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 1);
    const bool middle = ImGui::IsItemActive() && ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 1);
    const bool moves = io.MouseDelta.x != 0 || io.MouseDelta.y != 0;
    if ((left || middle) && moves) {
        state.view.follow = state.view.keep_all = false;
        if (middle || io.KeyShift)
            camera.Pan(io.MouseDelta.x, io.MouseDelta.y, area.height);
        else
            camera.Rotate(0.007 * io.MouseDelta.x, 0.007 * io.MouseDelta.y);
    }
    if (hovered && io.MouseWheel != 0) {
        camera.Zoom(std::pow(0.88, io.MouseWheel));
        state.view.keep_all = false;
    }
    if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        const ImVec2 scale = io.DisplayFramebufferScale;
        const auto x = static_cast<int>((io.MousePos.x - area.x) * scale.x);
        const auto y = static_cast<int>((io.MousePos.y - area.y) * scale.y);
        if (const auto point = scene.PointAt(x, y)) {
            state.view.follow = state.view.keep_all = false;
            camera.LookAt(*point);
        }
    }
    return left || middle ||
           (hovered && (io.MouseWheel != 0 || ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)));
}

void DrawToolbar(ViewerState& state, const ControlRect& area) {
    Controls& controls = state.controls;
    ViewChoices& view = state.view;
    ImGui::SetCursorScreenPos({area.x + Scaled(10), area.y + Scaled(10)});
    ImGui::PushFont(SmallFont());
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {Scaled(4), Scaled(4)});
    const auto button = [&](const char* name, const char* label, bool lit, const char* tip) {
        const bool pressed = MarkedButton(controls, name, label, 0, lit);
        Tip(tip);
        ImGui::SameLine();
        return pressed;
    };
    for (int i = 0; i < kShadings; ++i) {
        const auto shading = static_cast<Shading>(i);
        if (!state.CanShade(shading)) continue;
        const std::string name = std::string("shading.") + ToString(shading);
        if (button(name.c_str(), ToString(shading), view.shading == shading, "Shading  (C)"))
            view.shading = shading;
    }
    ImGui::Dummy({Scaled(6), 0});
    ImGui::SameLine();
    if (button("wireframe", "Wireframe", view.wireframe,
               "Show only the edges of the triangles  (W)"))
        view.wireframe = !view.wireframe;
    if (button("depth_test", "Depth test", view.depth_test,
               "Off: hidden surfaces show through  (D)"))
        view.depth_test = !view.depth_test;
    if (state.options.labelled &&
        button("objects", "Objects", view.show_objects, "Boxes and names of the objects  (B)"))
        view.show_objects = !view.show_objects;
    if (state.link && button("truth", "Truth", view.show_truth, "Ground-truth path, in white  (T)"))
        view.show_truth = !view.show_truth;
    ImGui::Dummy({Scaled(6), 0});
    ImGui::SameLine();
    if (state.link && button("follow", "Follow", view.follow, "Stay behind the sensor  (F)"))
        state.ToggleFollow();
    if (button("view_all", "All", view.keep_all, "Keep all of the mesh in view as it grows  (A)"))
        state.ViewAll();
    if (button("help", "Help", state.show_help, "Keys and mouse  (H)"))
        state.show_help = !state.show_help;
    ImGui::PopStyleVar();
    ImGui::PopFont();
}

}  // namespace

bool DrawViewPanel(ViewerState& state, SceneView& scene, const ViewPanelFrame& frame) {
    const ControlRect& area = frame.area;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    const Panel panel("view", area, ImGuiWindowFlags_NoScrollWithMouse);
    ImGui::PopStyleVar();
    ImGui::InvisibleButton("picture", {area.width, area.height},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle);
    ImGui::SetItemAllowOverlap();  // so that the buttons over it get input
    state.controls.MarkLast("view");
    const bool by_hand = HandlePointer(state, scene, area);
    if (state.view.keep_all) scene.ViewAll();
    const ImVec2 scale = ImGui::GetIO().DisplayFramebufferScale;
    const bool drawn =
        scene.Draw(state, {.width = std::max(static_cast<int>(area.width * scale.x), 1),
                           .height = std::max(static_cast<int>(area.height * scale.y), 1),
                           .may_redraw = frame.may_redraw,
                           .by_hand = by_hand,
                           .smooth = frame.smooth});
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 from{area.x, area.y}, to{area.x + area.width, area.y + area.height};
    list.AddRectFilledMultiColor(from, to, palette::kViewTop, palette::kViewTop,
                                 palette::kViewBottom, palette::kViewBottom);
    list.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(scene.texture())), from,
                  to);
    DrawObjectNames(state, scene, area);
    if (state.view.shading == Shading::kWeight)
        DrawLegend(list, {WeightColour, 0, 1, "weight 0", "255, logarithmic"},
                   {area.x, area.y + area.height - Scaled(34)},
                   {std::min(Scaled(360), area.width), Scaled(34)});
    DrawToolbar(state, area);
    return drawn;
}

}  // namespace tessera
