// Fast single-core decoding of image files into reusable storage, for frame sources. image_io.h is
// the simple interface for single images.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/status.h"
#include "io/image_header.h"
#include "io/png_decoder.h"

namespace tessera {

// Keeps its buffers between images. Owner thread only. Errors name the file and what is wrong with
// it; the image is then unspecified. Never throws.
class ImageDecoder {
  public:
    // Largest image side.
    static constexpr int kMaxSide_px = 8192;

    // Reads the file, and returns the image's size from its header: PNG, JPEG, PNM, BMP or TIFF.
    // Other formats and larger images are refused; nothing is decoded yet.
    Result<ImageSize> Load(const std::string& path);
    // These decode the loaded file. 8-bit colour or grey; grey is copied to all three channels.
    Status DecodeColour(ColourImage& image);
    // Raw 16-bit, single-channel values. The error for any other image states its bits and
    // channels.
    Status DecodeDepth(Image<std::uint16_t>& image);

    // Load and decode an image of any size.
    Status ReadColour(const std::string& path, ColourImage& image);
    Status ReadDepth(const std::string& path, Image<std::uint16_t>& image);

  private:
    Status DecodeLoadedColour(ColourImage& image);
    Status DecodeLoadedDepth(Image<std::uint16_t>& image);

    PngDecoder png_;
    std::string path_;
    ImageSize size_;  // of the loaded file
    std::vector<std::uint8_t> file_;
};

}  // namespace tessera
