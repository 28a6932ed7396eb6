// Measuring in the 3D view: the clicks, the figures beside the lines, and the tool's panel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "viz/measure_lines.h"
#include "viz/name_plates.h"
#include "viz/panels.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

std::string MeasuredText(double length_m) {
    return length_m < 1 ? fmt::format("{:.1f} cm", 100 * length_m)
                        : fmt::format("{:.3f} m", length_m);
}

// The surface at a pixel of the picture, or near it: a corner of a thing is easily missed.
std::optional<Eigen::Vector3d> NearPoint(const SceneView& scene, int x, int y) {
    constexpr int kFarthest_px = 3;
    for (int away = 0; away <= kFarthest_px; ++away)
        for (int dy = -away; dy <= away; ++dy)
            for (int dx = -away; dx <= away; ++dx) {
                if (std::max(std::abs(dx), std::abs(dy)) != away) continue;
                if (const auto p = scene.PointAt(x + dx, y + dy)) return p;
            }
    return std::nullopt;
}

// Where a world point is drawn; nullopt: behind the viewer.
std::optional<ImVec2> At(const SceneView& scene, const ControlRect& area,
                         const Eigen::Vector3d& p_world) {
    const auto pixel = scene.PixelOf(p_world);
    if (!pixel) return std::nullopt;
    const ImVec2 scale = ImGui::GetIO().DisplayFramebufferScale;
    return ImVec2{area.x + static_cast<float>(pixel->x()) / scale.x,
                  area.y + static_cast<float>(pixel->y()) / scale.y};
}

void DrawFigures(const SceneView& scene, const ControlRect& area, const Measurement& m,
                 NamePlates& plates) {
    const auto figure = [&](const Eigen::Vector3d& p_world, const std::string& text) {
        if (const auto at = At(scene, area, p_world))
            plates.Draw(*at, kMeasuredColour, text, false);
    };
    for (const MeasuredEdge& edge : EdgesOf(m))
        figure(0.5 * (edge.from + edge.to), MeasuredText(edge.length_m()));
    if (!m.closed) return;
    const std::vector<Eigen::Vector3d> top = TopCorners(m);
    const std::vector<Eigen::Vector3d>& shown = top.empty() ? m.corners : top;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& corner : shown)
        middle += corner / static_cast<double>(shown.size());
    figure(middle,
           m.top ? fmt::format("{:.3f} m3", Volume_m3(m)) : fmt::format("{:.3f} m2", Area_m2(m)));
}

// What the last measurement says beyond its edges.
std::vector<std::string> FiguresOf(const Measurement& m) {
    std::vector<std::string> lines;
    if (m.corners.size() > 2)
        lines.push_back(
            fmt::format("{} {}", m.closed ? "Around:" : "Length:", MeasuredText(Length_m(m))));
    std::string angles;
    for (std::size_t i = 0; i < m.corners.size(); ++i)
        if (const auto angle = Angle_deg(m, i)) angles += fmt::format(" {:.1f}", *angle);
    if (!angles.empty()) lines.push_back("Angles in degrees:" + angles);
    if (m.closed)
        lines.push_back(fmt::format("Area: {:.3f} m2, flat within {}", Area_m2(m),
                                    MeasuredText(Unevenness_m(m))));
    if (m.top)
        lines.push_back(
            fmt::format("Height: {}, volume: {:.3f} m3", MeasuredText(Height_m(m)), Volume_m3(m)));
    return lines;
}

const char* WhatNext(const Measuring& measuring) {
    const Measurement* const open = measuring.open();
    if (open && open->corners.size() >= 3)
        return "Click the first corner again for an area; Enter ends the line.";
    if (open) return "Click the next corner; Enter ends the line.";
    if (!measuring.all().empty() && measuring.all().back().closed)
        return "Shift and click: how high the body over the area is.";
    return "Click corners on the surface.";
}

}  // namespace

bool ClickToMeasure(ViewerState& state, const SceneView& scene, const ControlRect& area,
                    const Eigen::Vector2i& pixel) {
    constexpr float kStill_px = 4;  // a click moves less than that
    const ImGuiIO& io = ImGui::GetIO();
    if (!state.measuring.on() || !ImGui::IsItemHovered() ||
        !ImGui::IsMouseReleased(ImGuiMouseButton_Left) ||
        io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] > kStill_px * kStill_px)
        return false;
    const auto p = NearPoint(scene, pixel.x(), pixel.y());
    // Beside the surface, too, where the click makes an area.
    bool on_first = false;
    const Measurement* const open = state.measuring.open();
    if (open && open->corners.size() >= 3) {
        const auto first = At(scene, area, open->corners.front());
        on_first =
            first && std::hypot(first->x - io.MousePos.x, first->y - io.MousePos.y) < Scaled(9);
    }
    if (!p && !on_first) return false;
    state.measuring.Click(p.value_or(Eigen::Vector3d::Zero()), on_first, io.KeyShift);
    return true;
}

void DrawMeasurements(const ViewerState& state, const SceneView& scene, const ControlRect& area) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.PushClipRect({area.x, area.y}, {area.x + area.width, area.y + area.height}, true);
    NamePlates plates(list, 1);
    for (const Measurement& m : state.measuring.all()) {
        for (const Eigen::Vector3d& corner : m.corners)
            if (const auto at = At(scene, area, corner))
                list.AddCircleFilled(*at, Scaled(4), Packed(kMeasuredColour));
        DrawFigures(scene, area, m, plates);
    }
    list.PopClipRect();
}

void DrawMeasureTool(ViewerState& state) {
    GroupTitle("MEASURE");
    Measuring& measuring = state.measuring;
    SmallText(palette::kText, WhatNext(measuring));
    if (!measuring.all().empty())
        for (const std::string& line : FiguresOf(measuring.all().back()))
            SmallText(palette::kDim, line);
    if (!measuring.trouble().empty()) {
        ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + Scaled(300));
        SmallText(palette::kBad, measuring.trouble());
        ImGui::PopTextWrapPos();
    }
    if (MarkedButton(state.controls, "measure.back", "Take back", Scaled(80))) measuring.TakeBack();
    Tip("The last click is undone  (Backspace)");
    ImGui::SameLine();
    if (MarkedButton(state.controls, "measure.new", "New", Scaled(60))) measuring.Finish();
    Tip("The next click begins another measurement  (Enter)");
    ImGui::SameLine();
    if (MarkedButton(state.controls, "measure.clear", "Clear all", Scaled(80))) measuring.Clear();
    Tip("Take back, or Backspace, brings them back until the next click");
}

}  // namespace tessera
