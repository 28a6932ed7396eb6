#include "synth/texture.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/check.h"

namespace tessera {
namespace {

std::uint32_t Pack(std::uint32_t r, std::uint32_t g, std::uint32_t b) {
    return r | g << 8 | b << 16;
}

// Spreads the channels into 16-bit lanes, so that one multiplication or addition processes all
// three.
std::uint64_t Spread(std::uint32_t texel) {
    return (texel & 0xffu) | (texel & 0xff00u) << 8 |
           static_cast<std::uint64_t>(texel & 0xff0000u) << 16;
}

std::uint32_t MeanOfFour(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    const std::uint64_t sum = Spread(a) + Spread(b) + Spread(c) + Spread(d) + 0x000200020002ull;
    const auto lane = [sum](int shift) {
        return static_cast<std::uint32_t>(sum >> shift & 0x3ff) >> 2;
    };
    return Pack(lane(0), lane(16), lane(32));
}

// Index of a texel and its neighbour for a position in texels; weight of the neighbour in 1/16.
struct Axis {
    int first, second;
    std::uint32_t weight;
};

// std::floor is a library call with the baseline instruction set.
int Floor(float x) {
    const int truncated = static_cast<int>(x);
    return truncated - (x < static_cast<float>(truncated) ? 1 : 0);
}

// `position`: [0, 1] across the image.
Axis Locate(float position, int size, Texture::Wrap wrap) {
    const float texel = position * static_cast<float>(size) - 0.5f;
    const int index = Floor(texel);
    const auto weight = static_cast<std::uint32_t>((texel - static_cast<float>(index)) * 16.0f);
    int first = index, second = index + 1;
    if (first < 0) first = wrap == Texture::Wrap::kRepeat ? size - 1 : 0;
    if (second >= size) second = wrap == Texture::Wrap::kRepeat ? 0 : size - 1;
    return {std::min(first, size - 1), second, weight};
}

float WrapIntoImage(float position, Texture::Wrap wrap) {
    if (wrap == Texture::Wrap::kClamp) return std::clamp(position, 0.0f, 1.0f);
    return position - static_cast<float>(Floor(position));
}

}  // namespace

Texture::Texture(const ColourImage& image, Wrap wrap) : wrap_(wrap) {
    TESSERA_CHECK(!image.empty(), "a texture needs an image");
    Level base{image.width(), image.height(), {}};
    base.texels.reserve(image.size());
    for (std::size_t i = 0; i < image.size(); ++i) {
        const Rgb8 p = image.data()[i];
        base.texels.push_back(Pack(p.r, p.g, p.b));
    }
    levels_.push_back(std::move(base));
    while (levels_.back().width > 1 || levels_.back().height > 1) {
        const Level& fine = levels_.back();
        Level coarse{std::max(fine.width / 2, 1), std::max(fine.height / 2, 1), {}};
        coarse.texels.reserve(static_cast<std::size_t>(coarse.width) * coarse.height);
        for (int y = 0; y < coarse.height; ++y) {
            const int y0 = std::min(2 * y, fine.height - 1),
                      y1 = std::min(2 * y + 1, fine.height - 1);
            for (int x = 0; x < coarse.width; ++x) {
                const int x0 = std::min(2 * x, fine.width - 1),
                          x1 = std::min(2 * x + 1, fine.width - 1);
                coarse.texels.push_back(MeanOfFour(
                    fine.texels[y0 * fine.width + x0], fine.texels[y0 * fine.width + x1],
                    fine.texels[y1 * fine.width + x0], fine.texels[y1 * fine.width + x1]));
            }
        }
        levels_.push_back(std::move(coarse));
    }
}

// Processes all channels at once: four weights that sum to 256, times 8-bit values, fit into the
// 16-bit lanes.
RgbF Texture::SampleLevel(const Level& level, float u, float v) const {
    const Axis x = Locate(u, level.width, wrap_), y = Locate(v, level.height, wrap_);
    const std::uint32_t* row0 =
        level.texels.data() + static_cast<std::ptrdiff_t>(y.first) * level.width;
    const std::uint32_t* row1 =
        level.texels.data() + static_cast<std::ptrdiff_t>(y.second) * level.width;
    const std::uint64_t sum = Spread(row0[x.first]) * ((16 - x.weight) * (16 - y.weight)) +
                              Spread(row0[x.second]) * (x.weight * (16 - y.weight)) +
                              Spread(row1[x.first]) * ((16 - x.weight) * y.weight) +
                              Spread(row1[x.second]) * (x.weight * y.weight);
    constexpr float kScale = 1.0f / 256.0f;
    return {static_cast<float>(sum & 0xffff) * kScale,
            static_cast<float>(sum >> 16 & 0xffff) * kScale,
            static_cast<float>(sum >> 32 & 0xffff) * kScale};
}

RgbF Texture::Sample(float u, float v, float footprint) const {
    u = WrapIntoImage(u, wrap_);
    v = WrapIntoImage(v, wrap_);
    const float texels = footprint * static_cast<float>(levels_.front().width);
    if (!(texels > 1.0f)) return SampleLevel(levels_.front(), u, v);
    const int level =
        static_cast<int>(std::bit_cast<std::uint32_t>(texels) >> 23) - 127;  // floor(log2)
    return SampleLevel(levels_[std::min(level, static_cast<int>(levels_.size()) - 1)], u, v);
}

}  // namespace tessera
