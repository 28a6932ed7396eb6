// A rolling plot with the newest value at the right edge. Call inside an ImGui frame.
#pragma once

#include <imgui.h>

#include <span>

#include "viz/series.h"

namespace tessera {

struct Curve {
    const char* name = "";
    const Series* series = nullptr;
    ImU32 colour = 0;
};

// Draws title, unit, an axis from 0 to a round number (or to `axis_end` if positive), the curves
// and their last values. A tooltip shows the values under the mouse.
void DrawPlot(const char* title, const char* unit, std::span<const Curve> curves,
              const ImVec2& size, float axis_end = 0);

}  // namespace tessera
