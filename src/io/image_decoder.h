// Image files to pixels, as fast as one core can, into storage that is kept: what frame sources
// read with. image_io.h has the same for single images.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/status.h"
#include "io/png_decoder.h"

namespace tessera {

// Keeps its buffers between images. Owner thread only. Errors name the file and what is wrong with
// it; the image is then unspecified. Never throws.
class ImageDecoder {
  public:
    // No image has a longer side; refused from the header alone in PNG and JPEG.
    static constexpr int kMaxSide_px = 8192;

    // 8-bit colour or grey: PNG, JPEG, or whatever else OpenCV reads. Grey is spread over the three
    // channels.
    Status ReadColour(const std::string& path, ColourImage& image);
    // 16 bits and one channel; raw values. Anything else is refused by what it is.
    Status ReadDepth(const std::string& path, Image<std::uint16_t>& image);

  private:
    Status DecodeColour(ColourImage& image);
    Status DecodeDepth(Image<std::uint16_t>& image);

    PngDecoder png_;
    std::vector<std::uint8_t> file_;
};

}  // namespace tessera
