// A colour image with its mip pyramid, for the surfaces of synthetic scenes. Immutable after
// construction, hence thread-safe.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"

namespace tessera {

// Colour of a sample before quantisation, in grey levels [0, 255] per channel.
struct RgbF {
    float r = 0, g = 0, b = 0;
};

class Texture {
  public:
    enum class Wrap { kRepeat, kClamp };

    // `image` must not be empty; a 1x1 image is a flat colour.
    Texture(const ColourImage& image, Wrap wrap);

    // Bilinear sample from the pyramid level whose texels are between half the footprint and the
    // footprint in size; the renderer's samples per pixel average out the rest. (u, v) range over
    // [0, 1] from the top-left to the bottom-right corner of the image. Outside, the image repeats
    // or is clamped. `footprint`: extent of the sample as a share of the image width.
    RgbF Sample(float u, float v, float footprint) const;

    int width() const { return levels_.front().width; }
    int height() const { return levels_.front().height; }

  private:
    struct Level {
        int width, height;
        std::vector<std::uint32_t> texels;  // r, g, b from the lowest byte
    };
    RgbF SampleLevel(const Level& level, float u, float v) const;

    std::vector<Level> levels_;
    Wrap wrap_;
};

}  // namespace tessera
