// One frame as .klg logs store it: a header, depth (raw or zlib), colour (raw, JPEG or none).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/frame.h"
#include "core/status.h"
#include "io/rectifier.h"

struct libdeflate_decompressor;

namespace tessera {

// As stored, little endian.
struct KlgHeader {
    std::int64_t stamp_us = 0;
    std::int32_t depth_bytes = 0, colour_bytes = 0;

    // False if it is larger than a frame of this camera can be, or has no depth: stored as it is,
    // or as data that grew when it was compressed.
    bool Fits(const PinholeCamera& camera) const;
};
static_assert(sizeof(KlgHeader) == 16);

// Keeps its buffers between frames. Owner thread only.
class KlgFrameDecoder {
  public:
    struct Options {
        bool correct_distortion = true, swap_red_blue = false;
    };
    KlgFrameDecoder(const CameraCalibration& calibration, const Options& options);
    ~KlgFrameDecoder();

    // `bytes`: what follows a header that fits. Fills the frame's images; the error says what is
    // wrong with them, and `frame` is then as it was.
    Status Decode(std::span<const std::uint8_t> bytes, std::int32_t depth_bytes, Frame& frame);
    // The same without a frame, to check the bytes.
    Status Decode(std::span<const std::uint8_t> bytes, std::int32_t depth_bytes);
    bool rectifies() const { return rectifier_.active(); }
    bool corrects_lens() const { return rectifier_.corrects_lens(); }

  private:
    Status DecodeDepth(std::span<const std::uint8_t> bytes);
    Status DecodeColour(std::span<const std::uint8_t> bytes);
    Status DecodeCompressed(std::span<const std::uint8_t> bytes);

    struct FreeInflater {
        void operator()(libdeflate_decompressor* inflater) const;
    };
    PinholeCamera camera_;
    bool swap_red_blue_;
    Rectifier rectifier_;
    std::unique_ptr<libdeflate_decompressor, FreeInflater> inflater_;
    Image<std::uint16_t> depth_;
    ColourImage colour_;
};

}  // namespace tessera
