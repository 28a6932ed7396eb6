#include "viz/name_plates.h"

#include <algorithm>

#include "viz/theme.h"

namespace tessera {

void NamePlates::Draw(const ImVec2& at, const Rgb8& colour, const std::string& text, bool lit) {
    ImFont* const font = SmallFont();
    const ImVec2 extent = font->CalcTextSizeA(font->FontSize, 1e4f, 0, text.c_str());
    const float mark = Scaled(4), pad = Scaled(4), height = extent.y + Scaled(3);
    const ImVec4 plate = FreePlace({at.x, at.y - height, at.x + mark + extent.x + 2 * pad, at.y});
    const ImVec2 from{plate.x, plate.y}, to{plate.z, plate.w};
    const auto alpha = [&](float full) { return static_cast<unsigned>(full * opacity_); };
    list_.AddRectFilled(from, to, IM_COL32(14, 16, 19, alpha(215)), Scaled(3));
    list_.AddRectFilled(from, {from.x + mark, to.y}, Packed(colour, alpha(255)), Scaled(3),
                        ImDrawFlags_RoundCornersLeft);
    if (lit) list_.AddRect(from, to, IM_COL32(255, 255, 255, alpha(220)), Scaled(3));
    list_.AddText(font, font->FontSize, {from.x + mark + pad, from.y + Scaled(1)},
                  (palette::kText & ~IM_COL32_A_MASK) | (alpha(255) << IM_COL32_A_SHIFT),
                  text.c_str());
}

ImVec4 NamePlates::FreePlace(ImVec4 plate) {
    const float height = plate.w - plate.y;
    const auto in_the_way = [&](const ImVec4& other) {
        return plate.x < other.z && other.x < plate.z && plate.y < other.w && other.y < plate.w;
    };
    // Each step moves past one of the plates, so the loop terminates.
    for (auto other = std::ranges::find_if(drawn_, in_the_way); other != drawn_.end();
         other = std::ranges::find_if(drawn_, in_the_way)) {
        plate.w = other->y - 1;
        plate.y = plate.w - height;
    }
    drawn_.push_back(plate);
    return plate;
}

}  // namespace tessera
