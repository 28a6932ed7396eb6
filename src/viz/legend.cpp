#include "viz/legend.h"

#include "viz/theme.h"

namespace tessera {
namespace {

void DrawShadowed(ImDrawList& list, const ImVec2& at, ImU32 colour, const std::string& text) {
    const float size = SmallFont()->FontSize;
    list.AddText(SmallFont(), size, {at.x + 1, at.y + 1}, IM_COL32(0, 0, 0, 210), text.c_str());
    list.AddText(SmallFont(), size, at, colour, text.c_str());
}

}  // namespace

void DrawLegend(ImDrawList& list, const Legend& legend, const ImVec2& at, const ImVec2& size) {
    const auto width = [](const std::string& text) {
        return SmallFont()->CalcTextSizeA(SmallFont()->FontSize, 1e4f, 0, text.c_str()).x;
    };
    const float y = at.y + size.y - Scaled(17);
    list.AddRectFilledMultiColor({at.x, y - Scaled(8)}, {at.x + size.x, at.y + size.y}, 0, 0,
                                 IM_COL32(0, 0, 0, 190), IM_COL32(0, 0, 0, 190));
    DrawShadowed(list, {at.x + Scaled(6), y}, palette::kText, legend.first);
    DrawShadowed(list, {at.x + size.x - width(legend.last) - Scaled(6), y}, palette::kText,
                 legend.last);
    const float left = at.x + Scaled(12) + width(legend.first),
                right = at.x + size.x - Scaled(12) - width(legend.last);
    constexpr int kPieces = 24;
    for (int i = 0; i < kPieces; ++i) {
        const auto position = [&](int k) { return static_cast<float>(k) / kPieces; };
        const auto colour = [&](int k) {
            return Packed(legend.colour(legend.from + position(k) * (legend.to - legend.from)));
        };
        const ImU32 a = colour(i), b = colour(i + 1);
        list.AddRectFilledMultiColor({left + position(i) * (right - left), y + Scaled(4)},
                                     {left + position(i + 1) * (right - left), y + Scaled(10)}, a,
                                     b, b, a);
    }
}

}  // namespace tessera
