// Legends: a colour bar with the values at its ends, and a list of colours. Call inside an ImGui
// frame.
#pragma once

#include <imgui.h>

#include <span>
#include <string>

#include "core/image.h"
#include "viz/controls.h"

namespace tessera {

struct Legend {
    Rgb8 (*colour)(float) = nullptr;
    float from = 0, to = 1;  // range of the colour map's argument
    std::string first, last;
};

// Draws the bar along the lower edge of the area, with the values at its ends.
void DrawLegend(ImDrawList& list, const Legend& legend, const ImVec2& at, const ImVec2& size);

struct LegendItem {
    ImU32 colour = 0;  // 0: the scene's own colours
    std::string text;
    bool line = false;  // drawn as a line instead of a square
};

// Draws the items below each other on a dark plate. `bottom_left`: its corner. Returns the plate.
ControlRect DrawLegendItems(ImDrawList& list, std::span<const LegendItem> items,
                            const ImVec2& bottom_left);

}  // namespace tessera
