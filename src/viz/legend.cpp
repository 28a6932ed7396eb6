#include "viz/legend.h"

#include <algorithm>

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

ControlRect DrawLegendItems(ImDrawList& list, std::span<const LegendItem> items,
                            const ImVec2& bottom_left) {
    ImFont* const font = SmallFont();
    const float row = font->FontSize + Scaled(5), pad = Scaled(7), mark = Scaled(14);
    float widest = 0;
    for (const LegendItem& item : items)
        widest =
            std::max(widest, font->CalcTextSizeA(font->FontSize, 1e4f, 0, item.text.c_str()).x);
    const ImVec2 size{3 * pad + mark + widest, row * static_cast<float>(items.size()) + pad};
    const ImVec2 from{bottom_left.x, bottom_left.y - size.y};
    list.AddRectFilled(from, {from.x + size.x, from.y + size.y}, IM_COL32(14, 16, 19, 170),
                       Scaled(5));
    ImVec2 at{from.x + pad, from.y + 0.5f * pad};
    for (const LegendItem& item : items) {
        const float middle = at.y + 0.5f * row, half = Scaled(item.line ? 1.2f : 5.0f);
        const ImVec2 low{at.x, middle - half}, high{at.x + mark, middle + half};
        if (item.colour != 0)
            list.AddRectFilled(low, high, item.colour, item.line ? 0 : Scaled(2));
        else  // a few colours for all
            list.AddRectFilledMultiColor(low, high, IM_COL32(96, 156, 210, 255),
                                         IM_COL32(206, 190, 160, 255), IM_COL32(120, 170, 110, 255),
                                         IM_COL32(150, 110, 170, 255));
        list.AddText(font, font->FontSize, {at.x + mark + pad, middle - 0.55f * font->FontSize},
                     palette::kText, item.text.c_str());
        at.y += row;
    }
    return {from.x, from.y, size.x, size.y};
}

}  // namespace tessera
