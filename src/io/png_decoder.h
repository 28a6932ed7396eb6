// PNG decoding for the formats that RGB-D recordings use: 8 and 16 bits, grey or colour, not
// interlaced. libdeflate and the loops here take less than half the time of libpng through OpenCV
// (one core, 640x480: depth 1.1 instead of 2.7 ms, colour 2.3 instead of 4.6 ms), and PNG decoding
// is the largest part of reading a frame. Other formats are reported as such and left to OpenCV
// (image_decoder.cpp).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/status.h"

namespace tessera {

// Contents of a PNG's first chunk.
struct PngHeader {
    int width = 0, height = 0;  // pixels
    int bit_depth = 0;          // per channel
    int channels = 0;           // 1 grey or palette, 2 grey + alpha, 3 colour, 4 colour + alpha
    bool palette = false;
    bool interlaced = false;

    // Whether PngDecoder supports this format.
    bool common() const { return (bit_depth == 8 || bit_depth == 16) && !palette && !interlaced; }
};

bool IsPng(std::span<const std::uint8_t> file);

// nullopt if the file is not a PNG or its header is invalid.
std::optional<PngHeader> ReadPngHeader(std::span<const std::uint8_t> file);

// Keeps its buffers between images. Owner thread only.
class PngDecoder {
  public:
    PngDecoder();
    ~PngDecoder();
    PngDecoder(PngDecoder&&) noexcept;
    PngDecoder& operator=(PngDecoder&&) noexcept;

    // `header` must be the file's own, with common() true. Errors say what is wrong, without the
    // file name. Grey is copied to all three channels, alpha is dropped, and 16-bit values keep the
    // upper 8 bits.
    Status DecodeColour(std::span<const std::uint8_t> file, const PngHeader& header,
                        ColourImage& image);
    // 16 bits and one channel; raw values.
    Status DecodeDepth(std::span<const std::uint8_t> file, const PngHeader& header,
                       Image<std::uint16_t>& image);

  private:
    Status Inflate(std::span<const std::uint8_t> file, const PngHeader& header);

    struct Inflater;
    std::unique_ptr<Inflater> inflater_;
    std::vector<std::uint8_t> compressed_;
    std::vector<std::uint8_t> rows_;  // per row: filter type, then the filtered bytes
};

}  // namespace tessera
