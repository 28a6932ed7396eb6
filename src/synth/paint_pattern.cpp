// Patterns without lettering: noise, wood, tiles, stripes.
#include <algorithm>
#include <cmath>

#include "synth/hash_random.h"
#include "synth/paint.h"

namespace tessera {
namespace {

double Lattice(std::uint64_t key, int x, int y, int period_x, int period_y) {
    const int px = (x % period_x + period_x) % period_x, py = (y % period_y + period_y) % period_y;
    return UniformFromBits(MixBits(key + static_cast<std::uint64_t>(py) * 65537u + px)) - 0.5;
}

// Smooth, in [-0.5, 0.5], repeating after the periods.
double ValueNoise(std::uint64_t key, double x, double y, int period_x, int period_y) {
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
    const double a = smooth(x - x0), b = smooth(y - y0);
    const double top = std::lerp(Lattice(key, x0, y0, period_x, period_y),
                                 Lattice(key, x0 + 1, y0, period_x, period_y), a);
    const double bottom = std::lerp(Lattice(key, x0, y0 + 1, period_x, period_y),
                                    Lattice(key, x0 + 1, y0 + 1, period_x, period_y), a);
    return std::lerp(top, bottom, b);
}

// Octaves of halving size and weight; (u, v) in [0, 1).
double Octaves(std::uint64_t seed, double u, double v, int cells_x, int cells_y, int octaves) {
    double sum = 0, weight = 1;
    for (int i = 0; i < octaves; ++i, weight *= 0.6, cells_x *= 2, cells_y *= 2)
        sum += weight * ValueNoise(StreamKey(seed, i), u * cells_x, v * cells_y, cells_x, cells_y);
    return sum;
}

Rgb8 Shifted(Rgb8 base, double grey) {
    const auto channel = [grey](std::uint8_t c) {
        return static_cast<std::uint8_t>(std::clamp(c * (1 + grey / 160.0), 0.0, 255.0));
    };
    return {channel(base.r), channel(base.g), channel(base.b)};
}

// Calls colour(u, v) for the centre of each pixel.
template <class Function>
ColourImage Fill(int width, int height, const Function& colour) {
    ColourImage image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image(x, y) = colour((x + 0.5) / width, (y + 0.5) / height);
    return image;
}

}  // namespace

ColourImage PaintFlat(Rgb8 colour) { return ColourImage(1, 1, colour); }

ColourImage PaintChecker(Rgb8 a, Rgb8 b, int columns, int rows, int size_px) {
    return Fill(size_px, size_px, [&](double u, double v) {
        return (static_cast<int>(u * columns) + static_cast<int>(v * rows)) % 2 == 0 ? a : b;
    });
}

ColourImage PaintStripes(Rgb8 base, Rgb8 stripe, int size_px, std::uint64_t seed) {
    return Fill(size_px, size_px, [&](double u, double v) {
        const double phase = std::fmod(u * 8, 1.0);
        const bool wide = phase < 0.22, thin = phase > 0.55 && phase < 0.60;
        return Shifted(wide || thin ? stripe : base, 26 * Octaves(seed, u, v, 16, 16, 3));
    });
}

ColourImage PaintNoise(Rgb8 base, double contrast, int size_px, std::uint64_t seed) {
    return Fill(size_px, size_px,
                [&](double u, double v) { return Shifted(base, contrast * Octaves(seed, u, v, 8, 8, 5)); });
}

ColourImage PaintWood(Rgb8 base, int planks, int size_px, std::uint64_t seed) {
    return Fill(size_px, size_px, [&](double u, double v) {
        const int plank = static_cast<int>(v * planks);
        const double across = v * planks - plank;
        const std::uint64_t key = StreamKey(seed, plank);
        const double start = UniformFromBits(key);
        const double along = std::fmod(u + start, 1.0);
        const double tone = 40 * (UniformFromBits(MixBits(key)) - 0.5);
        // Rings: a warped coordinate across the plank; pores: short dark streaks.
        const double warp = Octaves(key, along, across, 3, 2, 3);
        const double rings = std::sin(40 * (across + 0.35 * warp));
        const double pores = Octaves(MixBits(key), along, across, 10, 48, 2);
        const bool gap = planks > 1 && (across < 0.018 || along < 0.004);
        return gap ? Shifted(base, -90) : Shifted(base, tone + 14 * rings + 44 * pores + 40 * warp);
    });
}

ColourImage PaintTiles(Rgb8 base, Rgb8 joint, int tiles, int size_px, std::uint64_t seed) {
    return Fill(size_px, size_px, [&](double u, double v) {
        const int column = static_cast<int>(u * tiles), row = static_cast<int>(v * tiles);
        const double x = u * tiles - column - 0.5, y = v * tiles - row - 0.5;
        const std::uint64_t key = StreamKey(seed, column, row);
        const double grain = 30 * Octaves(seed, u, v, 4 * tiles, 4 * tiles, 3);
        if (std::max(std::abs(x), std::abs(y)) > 0.48) return Shifted(joint, grain);
        const double tone = 50 * (UniformFromBits(key) - 0.5);
        const double radius = 0.12 + 0.25 * UniformFromBits(MixBits(key));
        const double round = std::hypot(x, y), square = std::abs(x) + std::abs(y);
        const double motif = key & 1 ? round : square;
        const bool inside = motif < radius && motif > radius - 0.1;
        return Shifted(base, tone + grain - (inside ? 70 : 0));
    });
}

}  // namespace tessera
