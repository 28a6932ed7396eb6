// PNG decoding for the kinds that RGB-D recordings are made of: 8 and 16 bits, grey or colour, not
// interlaced. libdeflate and the loops here take less than half of libpng's time, through OpenCV
// (one core, 640x480: depth 1.1 for 2.7 ms, colour 2.3 for 4.6 ms), and PNG is the largest part of
// reading a frame. Other kinds are reported as such and left to OpenCV (image_decoder.cpp).
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

// What a PNG's first chunk says.
struct PngHeader {
    int width = 0, height = 0;  // pixels
    int bit_depth = 0;          // per channel
    int channels = 0;           // 1 grey or palette, 2 grey + alpha, 3 colour, 4 colour + alpha
    bool palette = false;
    bool interlaced = false;

    // Whether PngDecoder decodes this kind.
    bool common() const { return (bit_depth == 8 || bit_depth == 16) && !palette && !interlaced; }
};

bool IsPng(std::span<const std::uint8_t> file);

// Nothing if the file is no PNG or its header is impossible.
std::optional<PngHeader> ReadPngHeader(std::span<const std::uint8_t> file);

// Keeps its buffers between images. Owner thread only.
class PngDecoder {
  public:
    PngDecoder();
    ~PngDecoder();
    PngDecoder(PngDecoder&&) noexcept;
    PngDecoder& operator=(PngDecoder&&) noexcept;

    // `header` is the file's own, with common() true. Errors say what is wrong, without the file's
    // name. Grey is spread over the three channels, alpha dropped, of 16 bits the upper 8 kept.
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
    std::vector<std::uint8_t> rows_;  // per row: the filter's number, then the filtered bytes
};

}  // namespace tessera
