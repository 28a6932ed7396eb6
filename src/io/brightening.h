// Evens out a lens's vignetting.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"

namespace tessera {

// Immutable.
class Brightening {
  public:
    // `vignetting`: the share of the brightness that is lost in the corners of images of this size.
    Brightening(int width, int height, double vignetting);

    // An empty image stays empty.
    void Apply(ColourImage& colour) const;

  private:
    // Of each channel of each pixel, in 256ths. Empty without vignetting.
    std::vector<std::uint16_t> factors_;
};

}  // namespace tessera
