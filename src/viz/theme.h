// Look of the window: a dark, neutral theme, its fonts and its semantic colours.
#pragma once

#include <imgui.h>

#include "core/image.h"

namespace tessera {

// Sets ImGui's style and fonts, with sizes multiplied by `scale`. Call after ImGui::CreateContext.
void ApplyTheme(float scale);
// Scales a size that is given for a standard-density display.
float Scaled(float size);

// Colour in ImGui's format; `alpha` up to 255.
inline ImU32 Packed(const Rgb8& c, unsigned alpha = 255) { return IM_COL32(c.r, c.g, c.b, alpha); }

ImFont* SmallFont();
ImFont* HeadingFont();
ImFont* TitleFont();  // of the start screen

namespace palette {
inline constexpr ImU32 kGood = IM_COL32(78, 201, 134, 255);
inline constexpr ImU32 kWarning = IM_COL32(240, 184, 72, 255);
inline constexpr ImU32 kBad = IM_COL32(235, 87, 87, 255);
inline constexpr ImU32 kIdle = IM_COL32(120, 126, 136, 255);
inline constexpr ImU32 kAccent = IM_COL32(84, 160, 255, 255);
inline constexpr ImU32 kLit = IM_COL32(47, 102, 176, 255);  // background of an active choice
inline constexpr ImU32 kText = IM_COL32(226, 229, 234, 255);
inline constexpr ImU32 kDim = IM_COL32(142, 149, 160, 255);
inline constexpr ImU32 kLine = IM_COL32(52, 57, 66, 255);
inline constexpr ImU32 kViewTop = IM_COL32(44, 49, 58, 255);
inline constexpr ImU32 kViewBottom = IM_COL32(20, 22, 26, 255);
// Curves of one plot.
inline constexpr ImU32 kCurves[] = {IM_COL32(84, 160, 255, 255),  IM_COL32(240, 184, 72, 255),
                                    IM_COL32(78, 201, 134, 255),  IM_COL32(221, 122, 205, 255),
                                    IM_COL32(120, 214, 224, 255), IM_COL32(235, 110, 87, 255)};
}  // namespace palette

}  // namespace tessera
