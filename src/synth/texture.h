// A colour image with its mip pyramid: what the surfaces of synthetic scenes are painted with.
// Immutable after construction, hence thread-safe.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"

namespace tessera {

// Colour of a sample before quantisation, each channel in grey levels [0, 255].
struct RgbF {
    float r = 0, g = 0, b = 0;
};

class Texture {
  public:
    enum class Wrap { kRepeat, kClamp };

    // `image` must not be empty; 1x1 is a flat colour.
    Texture(const ColourImage& image, Wrap wrap);

    // Bilinear, in the pyramid's level whose texels are as large as the footprint or up to half of
    // it: the renderer's several samples a pixel average the rest away. (u, v) run over [0, 1] from
    // the image's top-left to its bottom-right corner, outside of which the image repeats or is
    // continued; `footprint` is the sample's extent as a share of the image's width.
    RgbF Sample(float u, float v, float footprint) const;

    int width() const { return levels_.front().width; }
    int height() const { return levels_.front().height; }

  private:
    struct Level {
        int width, height;
        std::vector<std::uint32_t> texels;  // r, g, b from the lowest byte up
    };
    RgbF SampleLevel(const Level& level, float u, float v) const;

    std::vector<Level> levels_;
    Wrap wrap_;
};

}  // namespace tessera
