// A colour bar with the values at its ends. Call inside an ImGui frame.
#pragma once

#include <imgui.h>

#include <string>

#include "core/image.h"

namespace tessera {

struct Legend {
    Rgb8 (*colour)(float) = nullptr;
    float from = 0, to = 1;  // range of the colour map's argument
    std::string first, last;
};

// Draws the bar along the lower edge of the area, with the values at its ends.
void DrawLegend(ImDrawList& list, const Legend& legend, const ImVec2& at, const ImVec2& size);

}  // namespace tessera
