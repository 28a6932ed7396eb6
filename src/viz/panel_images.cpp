// What the camera measures beside what the map predicts.
#include <fmt/format.h>

#include <algorithm>

#include "viz/colour_map.h"
#include "viz/panels.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

constexpr int kTexturePx = 320;  // wider than it is shown

int StepFor(int width) {
    return std::max(1, (width + kTexturePx - 1) / kTexturePx);
}

ImU32 Packed(const Rgb8& c) {
    return IM_COL32(c.r, c.g, c.b, 255);
}

void DrawShadowed(ImDrawList& list, const ImVec2& at, ImU32 colour, const std::string& text) {
    const float size = SmallFont()->FontSize;
    list.AddText(SmallFont(), size, {at.x + 1, at.y + 1}, IM_COL32(0, 0, 0, 210), text.c_str());
    list.AddText(SmallFont(), size, at, colour, text.c_str());
}

struct Legend {
    Rgb8 (*colour)(float) = nullptr;
    float from = 0, to = 1;  // of the colour map
    std::string first, last;
};

// A bar along the lower edge with its ends' values.
void DrawLegend(ImDrawList& list, const Legend& legend, const ImVec2& at, const ImVec2& size) {
    const auto width = [](const std::string& text) {
        return SmallFont()->CalcTextSizeA(SmallFont()->FontSize, 1e4f, 0, text.c_str()).x;
    };
    const float y = at.y + size.y - Scaled(17);
    list.AddRectFilledMultiColor({at.x, y - Scaled(8)}, {at.x + size.x, at.y + size.y}, 0, 0, IM_COL32(0, 0, 0, 190),
                                 IM_COL32(0, 0, 0, 190));
    DrawShadowed(list, {at.x + Scaled(6), y}, palette::kText, legend.first);
    DrawShadowed(list, {at.x + size.x - width(legend.last) - Scaled(6), y}, palette::kText, legend.last);
    const float left = at.x + Scaled(12) + width(legend.first), right = at.x + size.x - Scaled(12) - width(legend.last);
    constexpr int kPieces = 24;
    for (int i = 0; i < kPieces; ++i) {
        const auto position = [&](int k) { return static_cast<float>(k) / kPieces; };
        const auto colour = [&](int k) {
            return Packed(legend.colour(legend.from + position(k) * (legend.to - legend.from)));
        };
        const ImU32 a = colour(i), b = colour(i + 1);
        list.AddRectFilledMultiColor({left + position(i) * (right - left), y + Scaled(4)},
                                     {left + position(i + 1) * (right - left), y + Scaled(10)}, a, b, b, a);
    }
}

void DrawImage(const char* title, const GlTexture& texture, const ImVec2& size, const char* missing,
               const Legend& legend) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 at = ImGui::GetCursorScreenPos(), to{at.x + size.x, at.y + size.y};
    list.AddRectFilled(at, to, IM_COL32(18, 20, 24, 255), Scaled(4));
    if (!texture.empty()) {
        // As large as fits, without distortion.
        const auto width = static_cast<float>(texture.width()), height = static_cast<float>(texture.height());
        const float scale = std::min(size.x / width, size.y / height);
        const ImVec2 part{scale * width, scale * height};
        const ImVec2 from{at.x + (size.x - part.x) / 2, at.y + (size.y - part.y) / 2};
        list.AddImageRounded(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture.name())), from,
                             {from.x + part.x, from.y + part.y}, {0, 0}, {1, 1}, IM_COL32_WHITE, Scaled(4));
        if (legend.colour) DrawLegend(list, legend, at, size);
    } else {
        const ImVec2 extent = SmallFont()->CalcTextSizeA(SmallFont()->FontSize, 1e4f, 0, missing);
        const ImVec2 from{at.x + (size.x - extent.x) / 2, at.y + (size.y - extent.y) / 2};
        list.AddText(SmallFont(), SmallFont()->FontSize, from, palette::kIdle, missing);
    }
    const ImVec2 extent = SmallFont()->CalcTextSizeA(SmallFont()->FontSize, 1e4f, 0, title);
    const ImVec2 label_to{at.x + extent.x + Scaled(14), at.y + extent.y + Scaled(6)};
    list.AddRectFilled(at, label_to, IM_COL32(14, 16, 19, 190), Scaled(4),
                       ImDrawFlags_RoundCornersTopLeft | ImDrawFlags_RoundCornersBottomRight);
    list.AddText(SmallFont(), SmallFont()->FontSize, {at.x + Scaled(7), at.y + Scaled(3)}, palette::kText, title);
    ImGui::Dummy(size);
}

}  // namespace

void ImagesPanel::Update(const ViewerState& state) {
    if (taken_ == state.system.images_taken()) return;
    taken_ = state.system.images_taken();
    const ImageUpdate& images = state.system.images();
    if (!images.frame) return;
    const Frame& frame = *images.frame;
    const auto far_m = static_cast<float>(state.settings.max_depth_m);
    if (frame.colour.empty())
        colour_.Clear();
    else
        colour_.Set(ShrinkColour(frame.colour, StepFor(frame.colour.width())));
    depth_.Set(DepthColours(frame.depth_m, far_m, StepFor(frame.depth_m.width())));
    if (images.predicted) {
        predicted_.Set(DepthColours(images.predicted->depth_m, far_m, StepFor(images.predicted->depth_m.width())));
        residual_.Set(ResidualColours(frame.depth_m, state.options.camera, *images.predicted,
                                      static_cast<float>(state.options.truncation_m)));
    } else {
        predicted_.Clear();
        residual_.Clear();
    }
}

void ImagesPanel::Draw(ViewerState& state, const ControlRect& area) {
    Update(state);
    const Panel panel("images", area);
    const float gap = ImGui::GetStyle().ItemSpacing.y, width = ImGui::GetContentRegionAvail().x;
    const float height = std::min(0.75f * width, (ImGui::GetContentRegionAvail().y - 3 * gap) / 4);
    const char* waiting = state.ended() ? "none" : "waiting for a frame";
    const char* unpredicted = state.settings.show_prediction ? waiting : "off";
    const Legend depth{SequentialColour, 0, 1, "0", fmt::format("{:.1f} m", state.settings.max_depth_m)};
    const std::string reach = fmt::format("{:.0f} mm", 1000 * state.options.truncation_m);
    const Legend difference{DivergingColour, -1, 1, "-" + reach, "+" + reach};
    DrawImage("Colour", colour_, {width, height}, state.system.images().frame ? "no colour" : waiting, {});
    DrawImage("Depth", depth_, {width, height}, waiting, depth);
    DrawImage("Predicted depth", predicted_, {width, height}, unpredicted, depth);
    DrawImage("Measured minus predicted", residual_, {width, height}, unpredicted, difference);
}

}  // namespace tessera
