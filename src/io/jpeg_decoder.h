// JPEG decoding through libjpeg-turbo. It gives the same pixels as OpenCV in three quarters of the
// time, in RGB order. Damaged data is an error here, not a grey area and a line on stderr.
#pragma once

#include <cstdint>
#include <span>

#include "core/image.h"
#include "core/status.h"

namespace tessera {

bool IsJpeg(std::span<const std::uint8_t> file);

// Fills `image` (its storage is reused). Grey is copied to all three channels. Images with a side
// over max_side_px are refused before decoding. Errors say what is wrong, without the file name.
// Thread-safe.
Status DecodeJpeg(std::span<const std::uint8_t> file, int max_side_px, ColourImage& image);

}  // namespace tessera
