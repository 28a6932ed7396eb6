// A rolling plot: the newest value at the right edge. Inside an ImGui frame.
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

// Title, unit, axis from 0 to a round number (or to `axis_end`, if positive), the curves and their
// last values; the values under the pointer in a tip.
void DrawPlot(const char* title, const char* unit, std::span<const Curve> curves,
              const ImVec2& size, float axis_end = 0);

}  // namespace tessera
