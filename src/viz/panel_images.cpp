// Measured images next to the map's prediction.
#include <fmt/format.h>

#include <algorithm>

#include "viz/colour_map.h"
#include "viz/legend.h"
#include "viz/panels.h"
#include "viz/widgets.h"

namespace tessera {
namespace {

constexpr int kTexturePx = 320;  // wider than displayed

int StepFor(int width) { return std::max(1, (width + kTexturePx - 1) / kTexturePx); }

// Returns where the image was drawn; empty without an image.
ImVec4 DrawImage(const char* title, const GlTexture& texture, const ImVec2& size,
                 const char* missing, const Legend& legend) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 at = ImGui::GetCursorScreenPos(), to{at.x + size.x, at.y + size.y};
    ImVec4 drawn{};
    list.AddRectFilled(at, to, IM_COL32(18, 20, 24, 255), Scaled(4));
    if (!texture.empty()) {
        // As large as possible without distortion.
        const auto width = static_cast<float>(texture.width()),
                   height = static_cast<float>(texture.height());
        const float scale = std::min(size.x / width, size.y / height);
        const ImVec2 part{scale * width, scale * height};
        const ImVec2 from{at.x + (size.x - part.x) / 2, at.y + (size.y - part.y) / 2};
        list.AddImageRounded(
            reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture.name())), from,
            {from.x + part.x, from.y + part.y}, {0, 0}, {1, 1}, IM_COL32_WHITE, Scaled(4));
        drawn = {from.x, from.y, from.x + part.x, from.y + part.y};
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
    list.AddText(SmallFont(), SmallFont()->FontSize, {at.x + Scaled(7), at.y + Scaled(3)},
                 palette::kText, title);
    ImGui::Dummy(size);
    return drawn;
}

}  // namespace

void ImagesPanel::Update(const ViewerState& state) {
    if (taken_ == state.system.images_taken()) return;
    taken_ = state.system.images_taken();
    const ImageUpdate& images = state.system.images();
    if (!images.frame) return;
    const Frame& frame = *images.frame;
    const auto far_m = static_cast<float>(state.settings.max_depth_m);
    const int step = StepFor(frame.depth_m.width());
    const auto tinted = [&](ColourImage picture) {
        if (images.moving) TintMoving(*images.moving, step, picture);
        return picture;
    };
    if (frame.colour.empty())
        colour_.Clear();
    else
        colour_.Set(tinted(ShrinkColour(frame.colour, step)));
    depth_.Set(tinted(DepthColours(frame.depth_m, far_m, step)));
    if (images.predicted) {
        predicted_.Set(DepthColours(images.predicted->depth_m, far_m,
                                    StepFor(images.predicted->depth_m.width())));
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
    const Legend depth{SequentialColour, 0, 1, "0",
                       fmt::format("{:.1f} m", state.settings.max_depth_m)};
    const std::string reach = fmt::format("{:.0f} mm", 1000 * state.options.truncation_m);
    const Legend difference{DivergingColour, -1, 1, "-" + reach, "+" + reach};
    const ImVec4 colour = DrawImage("Camera", colour_, {width, height},
                                    state.system.images().frame ? "no colour" : waiting, {});
    DrawDetections(state, {colour.x, colour.y}, {colour.z, colour.w});
    DrawImage("Measured depth", depth_, {width, height}, waiting, depth);
    DrawImage("Predicted depth", predicted_, {width, height}, unpredicted, depth);
    DrawImage(area.width < Scaled(190) ? "Difference" : "Measured minus predicted", residual_,
              {width, height}, unpredicted, difference);
}

}  // namespace tessera
