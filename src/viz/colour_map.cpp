#include "viz/colour_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace tessera {
namespace {

Rgb8 Interpolate(std::span<const Rgb8> stops, float position) {
    const float at = std::clamp(position, 0.0f, 1.0f) * static_cast<float>(stops.size() - 1);
    const auto index = std::min(static_cast<std::size_t>(at), stops.size() - 2);
    const float part = at - static_cast<float>(index);
    const auto mix = [part](std::uint8_t a, std::uint8_t b) {
        const float value = (1 - part) * static_cast<float>(a) + part * static_cast<float>(b);
        return static_cast<std::uint8_t>(std::lround(value));
    };
    const Rgb8 &a = stops[index], &b = stops[index + 1];
    return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

// All shades of a colour map, so that an image needs only one look-up per pixel.
template <Rgb8 (*Colour)(float)>
const std::array<Rgb8, 256>& Shades() {
    static const std::array<Rgb8, 256> shades = [] {
        std::array<Rgb8, 256> table;
        for (std::size_t i = 0; i < table.size(); ++i)
            table[i] = Colour(static_cast<float>(i) / 255);
        return table;
    }();
    return shades;
}

Rgb8 DivergingFromUnit(float value) { return DivergingColour(2 * value - 1); }

std::size_t Shade(float unit) {
    return static_cast<std::size_t>(std::clamp(unit, 0.0f, 1.0f) * 255 + 0.5f);
}

}  // namespace

const std::array<Rgb8, kWeightStops> kWeightColours{
    {{44, 24, 84}, {58, 84, 152}, {34, 148, 144}, {126, 200, 88}, {250, 228, 96}}};

Rgb8 WeightColour(float value) { return Interpolate(kWeightColours, value); }

Rgb8 SequentialColour(float value) {
    static constexpr std::array<Rgb8, 7> kStops{{{150, 20, 60},
                                                 {222, 82, 62},
                                                 {250, 165, 88},
                                                 {246, 228, 140},
                                                 {132, 205, 160},
                                                 {54, 142, 186},
                                                 {72, 62, 140}}};
    return Interpolate(kStops, value);
}

Rgb8 DivergingColour(float value) {
    static constexpr std::array<Rgb8, 5> kStops{
        {{178, 24, 43}, {236, 138, 106}, {245, 245, 245}, {112, 176, 216}, {33, 92, 168}}};
    return Interpolate(kStops, 0.5f * (value + 1));
}

ColourImage ShrinkColour(const ColourImage& image, int step) {
    ColourImage small(image.width() / step, image.height() / step);
    for (int y = 0; y < small.height(); ++y)
        for (int x = 0; x < small.width(); ++x) {
            int r = 0, g = 0, b = 0;
            for (int dy = 0; dy < step; ++dy) {
                const Rgb8* row = image.row(y * step + dy) + x * step;
                for (int dx = 0; dx < step; ++dx) r += row[dx].r, g += row[dx].g, b += row[dx].b;
            }
            const int n = step * step;
            small(x, y) = {static_cast<std::uint8_t>(r / n), static_cast<std::uint8_t>(g / n),
                           static_cast<std::uint8_t>(b / n)};
        }
    return small;
}

ColourImage DepthColours(const DepthImage& depth_m, float far_m, int step) {
    const auto& shades = Shades<SequentialColour>();
    ColourImage out(depth_m.width() / step, depth_m.height() / step, kNothingShown);
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x)
            if (const float z = depth_m(x * step, y * step); z > 0)
                out(x, y) = shades[Shade(z / far_m)];
    return out;
}

ColourImage ResidualColours(const DepthImage& measured_m, const PinholeCamera& camera,
                            const PredictedView& predicted, float reach_m) {
    const auto& shades = Shades<DivergingFromUnit>();
    const PinholeCamera& small = predicted.camera;
    ColourImage out(predicted.depth_m.width(), predicted.depth_m.height(), kNothingShown);
    for (int v = 0; v < out.height(); ++v) {
        const int y =
            static_cast<int>(std::lround((v - small.cy) / small.fy * camera.fy + camera.cy));
        for (int u = 0; u < out.width(); ++u) {
            const int x =
                static_cast<int>(std::lround((u - small.cx) / small.fx * camera.fx + camera.cx));
            if (!measured_m.Contains(x, y)) continue;
            const float z = measured_m(x, y), expected = predicted.depth_m(u, v);
            if (z > 0 && expected > 0)
                out(u, v) = shades[Shade(0.5f + 0.5f * (z - expected) / reach_m)];
        }
    }
    return out;
}

}  // namespace tessera
