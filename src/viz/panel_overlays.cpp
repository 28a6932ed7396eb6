// What is drawn over the 3D view: the scale bar and the legends.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "viz/colour_map.h"
#include "viz/legend.h"
#include "viz/panels.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

std::string LengthText(double length_m) {
    if (length_m < 0.01) return fmt::format("{:g} mm", 1000 * length_m);
    if (length_m < 1) return fmt::format("{:g} cm", 100 * length_m);
    return fmt::format("{:g} m", length_m);
}

// Exact for what lies as far from the eye as the centre of the view.
void DrawScaleBar(ViewerState& state, SceneView& scene, const ControlRect& area, float right) {
    const double pixel_m = scene.camera().PixelSize_m(area.height);
    const double length_m = ScaleBarLength_m(pixel_m * Scaled(130));
    const auto width = static_cast<float>(length_m / pixel_m);
    const std::string text = LengthText(length_m);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImFont* const font = SmallFont();
    const float text_width = font->CalcTextSizeA(font->FontSize, 1e4f, 0, text.c_str()).x;
    const float y = area.y + area.height - Scaled(14), x = right - Scaled(14) - width;
    const float pad = Scaled(6), line = Scaled(1.5f);
    list.AddRectFilled({x - pad, y - Scaled(20)}, {x + width + pad, y + pad},
                       IM_COL32(14, 16, 19, 170), Scaled(5));
    list.AddLine({x, y}, {x + width, y}, palette::kText, line);
    for (const float end : {x, x + width})
        list.AddLine({end, y - Scaled(5)}, {end, y}, palette::kText, line);
    list.AddText(font, font->FontSize, {x + (width - text_width) / 2, y - Scaled(18)},
                 palette::kText, text.c_str());
    state.controls.Mark("scale_bar", {x, y - Scaled(18), width, Scaled(18)});
}

std::vector<LegendItem> CoverageItems() {
    return {{Packed(kOnceColour), "seen once"},
            {Packed(kThinColour), "thin: go over it again"},
            {0, "own colours: well measured"}};
}

std::vector<LegendItem> PathItems(const ViewerState& state) {
    if (state.replay)
        return {
            {palette::kAccent, "path so far", true},
            {(palette::kAccent & ~IM_COL32_A_MASK) | (128u << IM_COL32_A_SHIFT), "the rest", true}};
    if (!state.link) return {};
    std::vector<LegendItem> items{{palette::kAccent, "path of the camera", true}};
    if (state.view_kind == ViewKind::kScan) return items;
    items.push_back({palette::kWarning, "tracked badly", true});
    if (state.view.show_truth && !state.system.truth().empty())
        items.push_back({palette::kText, "true path", true});
    return items;
}

}  // namespace

void DrawOverlays(ViewerState& state, SceneView& scene, const ControlRect& area, float right) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const Shading shading = state.shading();
    std::vector<LegendItem> items;
    if (shading == Shading::kCoverage) items = CoverageItems();
    for (LegendItem& item : PathItems(state)) items.push_back(std::move(item));
    float bottom = area.y + area.height - Scaled(8);
    if (shading == Shading::kWeight) {
        DrawLegend(list, {WeightColour, 0, 1, "weight 0", "255, logarithmic"},
                   {area.x, area.y + area.height - Scaled(34)},
                   {std::min(Scaled(360), area.width - Scaled(170)), Scaled(34)});
        bottom -= Scaled(30);
    }
    if (!items.empty()) {
        const ControlRect drawn = DrawLegendItems(list, items, {area.x + Scaled(8), bottom});
        state.controls.Mark("legend", drawn);
    }
    DrawScaleBar(state, scene, area, right);
}

}  // namespace tessera
