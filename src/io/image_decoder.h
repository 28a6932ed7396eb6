// Fast single-core decoding of image files into reusable storage, for frame sources. image_io.h is
// the simple interface for single images.
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
    // Largest image side. PNG and JPEG files that exceed it are refused from the header alone.
    static constexpr int kMaxSide_px = 8192;

    // Reads 8-bit colour or grey: PNG, JPEG, or any other format OpenCV reads. Grey is copied to
    // all three channels.
    Status ReadColour(const std::string& path, ColourImage& image);
    // Reads raw 16-bit, single-channel values. The error for any other image states its bits and
    // channels.
    Status ReadDepth(const std::string& path, Image<std::uint16_t>& image);

  private:
    Status DecodeColour(ColourImage& image);
    Status DecodeDepth(Image<std::uint16_t>& image);

    PngDecoder png_;
    std::vector<std::uint8_t> file_;
};

}  // namespace tessera
