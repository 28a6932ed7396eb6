// A colour map's bar with the values at its ends. Inside an ImGui frame.
#pragma once

#include <imgui.h>

#include <string>

#include "core/image.h"

namespace tessera {

struct Legend {
    Rgb8 (*colour)(float) = nullptr;
    float from = 0, to = 1;  // of the colour map
    std::string first, last;
};

// A bar along the lower edge of the area with its ends' values.
void DrawLegend(ImDrawList& list, const Legend& legend, const ImVec2& at, const ImVec2& size);

}  // namespace tessera
