#include "viz/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "viz/theme.h"

namespace tessera {
namespace {

std::string ValueText(float value, const char* unit) {
    return *unit == 0   ? fmt::format("{:g}", value)
           : value < 10 ? fmt::format("{:.1f}", value)
                        : fmt::format("{:.0f}", value);
}

float LastOf(const Series& series) { return series.empty() ? 0 : series.back(); }

struct PlotFrame {
    ImVec2 from, to;
    float end = 1;

    ImVec2 At(const Series& series, std::size_t i) const {
        const std::size_t age = series.size() - 1 - i;
        const float step = (to.x - from.x) / static_cast<float>(kSeriesLength - 1);
        const float part = std::clamp(series[i] / end, 0.0f, 1.0f);
        return {to.x - step * static_cast<float>(age), to.y - part * (to.y - from.y)};
    }
};

void DrawCurve(ImDrawList& list, const PlotFrame& frame, const Curve& curve, bool filled) {
    std::vector<ImVec2> points(curve.series->size());
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = frame.At(*curve.series, i);
    const ImU32 shade = (curve.colour & ~IM_COL32_A_MASK) | (44u << IM_COL32_A_SHIFT);
    const ImDrawListFlags flags = list.Flags;
    list.Flags &= ~ImDrawListFlags_AntiAliasedFill;  // anti-aliasing would show seams
    if (filled)
        for (std::size_t i = 1; i < points.size(); ++i)
            list.AddQuadFilled({points[i - 1].x, frame.to.y}, points[i - 1], points[i],
                               {points[i].x, frame.to.y}, shade);
    list.Flags = flags;
    list.AddPolyline(points.data(), static_cast<int>(points.size()), curve.colour, 0, Scaled(1.4f));
}

// Draws names and last values along the top, as far as they fit.
void DrawCurveNames(ImDrawList& list, std::span<const Curve> curves, ImVec2 at, float right) {
    for (const Curve& curve : curves) {
        const std::string text = fmt::format("{} {:.0f}", curve.name, LastOf(*curve.series));
        const float width = ImGui::CalcTextSize(text.c_str()).x;
        if (at.x + width + Scaled(10) > right) return;
        const float y = at.y + 0.5f * ImGui::GetTextLineHeight();
        list.AddRectFilled({at.x, y - Scaled(3)}, {at.x + Scaled(6), y + Scaled(3)}, curve.colour,
                           Scaled(1));
        list.AddText({at.x + Scaled(10), at.y}, palette::kText, text.c_str());
        at.x += width + Scaled(17);
    }
}

void DrawTip(std::span<const Curve> curves, const PlotFrame& frame, const char* unit) {
    const float from_right = (frame.to.x - ImGui::GetIO().MousePos.x) / (frame.to.x - frame.from.x);
    ImGui::BeginTooltip();
    for (const Curve& curve : curves) {
        const Series& series = *curve.series;
        const float steps = from_right * static_cast<float>(kSeriesLength - 1);
        const auto age = static_cast<std::size_t>(std::max(steps + 0.5f, 0.0f));
        if (age >= series.size()) continue;
        const std::string value = ValueText(series[series.size() - 1 - age], unit);
        ImGui::TextUnformatted(
            fmt::format("{} {} {}, {} frames ago", curve.name, value, unit, age).c_str());
    }
    ImGui::EndTooltip();
}

}  // namespace

void DrawPlot(const char* title, const char* unit, std::span<const Curve> curves,
              const ImVec2& size, float axis_end) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Dummy(size);
    const bool hovered = ImGui::IsItemHovered();
    ImGui::PushFont(SmallFont());
    const float line = ImGui::GetTextLineHeight(), right = at.x + size.x;
    PlotFrame frame{{at.x, at.y + line + Scaled(6)}, {right, at.y + size.y}, axis_end};
    if (axis_end <= 0) {
        float most = 0;
        for (const Curve& curve : curves)
            for (const float value : *curve.series) most = std::max(most, value);
        frame.end = AxisEnd(most);
    }
    list.AddText(at, palette::kDim, title);
    const float title_width = ImGui::CalcTextSize(title).x;
    if (curves.size() > 1) {
        DrawCurveNames(list, curves, {at.x + title_width + Scaled(14), at.y}, right);
    } else if (!curves.empty()) {
        const std::string value =
            fmt::format("{} {}", ValueText(LastOf(*curves[0].series), unit), unit);
        const float from = right - ImGui::CalcTextSize(value.c_str()).x;
        if (from > at.x + title_width + Scaled(6))  // else only the tooltip shows it
            list.AddText({from, at.y}, palette::kText, value.c_str());
    }
    list.AddRectFilled(frame.from, frame.to, IM_COL32(18, 20, 24, 255), Scaled(3));
    const float middle = 0.5f * (frame.from.y + frame.to.y);
    list.AddLine({frame.from.x, middle}, {frame.to.x, middle}, IM_COL32(255, 255, 255, 14));
    list.PushClipRect(frame.from, frame.to, true);
    for (const Curve& curve : curves) DrawCurve(list, frame, curve, curves.size() == 1);
    list.PopClipRect();
    const std::string top = fmt::format("{:g} {}", frame.end, unit);
    list.AddText({frame.from.x + Scaled(4), frame.from.y + Scaled(2)}, palette::kDim, top.c_str());
    list.AddText({frame.from.x + Scaled(4), frame.to.y - line - Scaled(1)}, palette::kDim, "0");
    ImGui::PopFont();
    if (hovered && !curves.empty()) DrawTip(curves, frame, unit);
}

}  // namespace tessera
