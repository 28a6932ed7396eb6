// The 3D view: its picture and mouse control.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "viz/panels.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

// In first person the wheel walks.
void Zoom(ViewerState& state, ViewCamera& camera, float steps) {
    constexpr double kStep_m = 0.15;
    state.view.keep_all = false;
    if (!state.view.first_person) return camera.Zoom(std::pow(0.88, steps));
    state.view.follow = false;
    camera.Walk(kStep_m * steps);
}

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
        constexpr double kRadPerPx = 0.007, kTurnRadPerPx = 0.003;
        if (middle || io.KeyShift)
            camera.Pan(io.MouseDelta.x, io.MouseDelta.y, area.height);
        else if (state.view.first_person)
            camera.Turn(-kTurnRadPerPx * io.MouseDelta.x, -kTurnRadPerPx * io.MouseDelta.y);
        else
            camera.Rotate(kRadPerPx * io.MouseDelta.x, kRadPerPx * io.MouseDelta.y);
    }
    const bool wheel = hovered && io.MouseWheel != 0;
    if (wheel) Zoom(state, camera, io.MouseWheel);
    const ImVec2 scale = io.DisplayFramebufferScale;
    const Eigen::Vector2i pixel(static_cast<int>((io.MousePos.x - area.x) * scale.x),
                                static_cast<int>((io.MousePos.y - area.y) * scale.y));
    if (state.measuring.on())
        return ClickToMeasure(state, scene, area, pixel) || left || middle || wheel;
    if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        if (const auto point = scene.PointAt(pixel.x(), pixel.y())) {
            state.view.follow = state.view.keep_all = false;
            camera.LookAt(*point);
        }
    }
    return left || middle || wheel ||
           (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left));
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
    if (state.view.keep_all) scene.ViewAll(state);
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
    DrawMeasurements(state, scene, area);
    if (scene.triangles() > 0)
        DrawOverlays(state, scene, area, area.x + area.width - frame.inset_width);
    if (state.view_kind == ViewKind::kExpert) DrawToolbar(state, area);
    DrawTools(state, scene, area);
    if (!frame.smooth) DrawNote(state, area, frame.inset_width);  // pictures are without it
    return drawn;
}

}  // namespace tessera
