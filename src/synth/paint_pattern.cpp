// Patterns without lettering: noise, wood, tiles, stripes.
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "synth/hash_random.h"
#include "synth/paint.h"

namespace tessera {
namespace {

// Value noise of several octaves with halving size and weights 1, 0.6, 0.36 ... Smooth, zero mean,
// period 1 along both axes. The first octave has cells_x by cells_y cells.
class PeriodicNoise {
  public:
    PeriodicNoise(std::uint64_t seed, int cells_x, int cells_y, int octaves) {
        float weight = 1;
        for (int i = 0; i < octaves; ++i, weight *= 0.6f, cells_x *= 2, cells_y *= 2) {
            Layer layer{cells_x, cells_y, {}};
            const std::uint64_t key = StreamKey(seed, static_cast<std::uint64_t>(i));
            for (int k = 0; k < cells_x * cells_y; ++k)
                layer.values.push_back(
                    weight *
                    static_cast<float>(
                        UniformFromBits(MixBits(key + static_cast<std::uint64_t>(k))) - 0.5));
            layers_.push_back(std::move(layer));
        }
    }
    // u and v in [0, 1).
    double operator()(double u, double v) const {
        float sum = 0;
        for (const Layer& layer : layers_)
            sum += layer.At(static_cast<float>(u), static_cast<float>(v));
        return sum;
    }

  private:
    struct Layer {
        int columns, rows;
        std::vector<float> values;
        float At(float u, float v) const {
            const float x = u * static_cast<float>(columns), y = v * static_cast<float>(rows);
            const int x0 = std::min(static_cast<int>(x), columns - 1),
                      y0 = std::min(static_cast<int>(y), rows - 1);
            const int x1 = x0 + 1 == columns ? 0 : x0 + 1, y1 = y0 + 1 == rows ? 0 : y0 + 1;
            const float a = Smooth(x - static_cast<float>(x0)),
                        b = Smooth(y - static_cast<float>(y0));
            const float* row0 = values.data() + static_cast<std::ptrdiff_t>(y0) * columns;
            const float* row1 = values.data() + static_cast<std::ptrdiff_t>(y1) * columns;
            const float top = row0[x0] + a * (row0[x1] - row0[x0]),
                        low = row1[x0] + a * (row1[x1] - row1[x0]);
            return top + b * (low - top);
        }
        static float Smooth(float t) { return t * t * (3 - 2 * t); }
    };
    std::vector<Layer> layers_;
};

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
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x) image(x, y) = colour((x + 0.5) / width, (y + 0.5) / height);
    });
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
    const PeriodicNoise grain(seed, 16, 16, 3);
    return Fill(size_px, size_px, [&](double u, double v) {
        const double phase = std::fmod(u * 8, 1.0);
        const bool wide = phase<0.22, thin = phase> 0.55 && phase < 0.60;
        return Shifted(wide || thin ? stripe : base, 26 * grain(u, v));
    });
}

ColourImage PaintNoise(Rgb8 base, double contrast, int size_px, std::uint64_t seed) {
    const PeriodicNoise noise(seed, 8, 8, 5);
    return Fill(size_px, size_px,
                [&](double u, double v) { return Shifted(base, contrast * noise(u, v)); });
}

ColourImage PaintWood(Rgb8 base, int planks, int size_px, std::uint64_t seed) {
    struct Plank {
        double start, tone;
        PeriodicNoise warp, pores;
    };
    std::vector<Plank> boards;
    for (int i = 0; i < planks; ++i) {
        const std::uint64_t key = StreamKey(seed, static_cast<std::uint64_t>(i)),
                            other = MixBits(key);
        boards.push_back({UniformFromBits(key), 40 * (UniformFromBits(other) - 0.5),
                          PeriodicNoise(key, 3, 2, 3), PeriodicNoise(other, 10, 48, 2)});
    }
    return Fill(size_px, size_px, [&](double u, double v) {
        const int number = std::min(static_cast<int>(v * planks), planks - 1);
        const Plank& plank = boards[static_cast<std::size_t>(number)];
        const double across = v * planks - number, along = std::fmod(u + plank.start, 1.0);
        if (planks > 1 && (across < 0.018 || along < 0.004)) return Shifted(base, -90);
        // Rings use a warped coordinate across the plank; pores are short dark streaks.
        const double warp = plank.warp(along, across);
        const double rings = std::sin(40 * (across + 0.35 * warp));
        return Shifted(base, plank.tone + 14 * rings + 44 * plank.pores(along, across) + 40 * warp);
    });
}

ColourImage PaintTiles(Rgb8 base, Rgb8 joint, int tiles, int size_px, std::uint64_t seed) {
    const PeriodicNoise noise(seed, 4 * tiles, 4 * tiles, 3);
    return Fill(size_px, size_px, [&](double u, double v) {
        const int column = static_cast<int>(u * tiles), row = static_cast<int>(v * tiles);
        const double x = u * tiles - column - 0.5, y = v * tiles - row - 0.5;
        const std::uint64_t key =
            StreamKey(seed, static_cast<std::uint64_t>(column), static_cast<std::uint64_t>(row));
        const double grain = 30 * noise(u, v);
        if (std::max(std::abs(x), std::abs(y)) > 0.48) return Shifted(joint, grain);
        const double tone = 50 * (UniformFromBits(key) - 0.5);
        const double radius = 0.12 + 0.25 * UniformFromBits(MixBits(key));
        const double motif = key & 1 ? std::hypot(x, y) : std::abs(x) + std::abs(y);
        const bool inside = motif < radius && motif > radius - 0.1;
        return Shifted(base, tone + grain - (inside ? 70 : 0));
    });
}

}  // namespace tessera
