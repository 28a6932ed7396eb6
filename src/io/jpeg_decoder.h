// JPEG decoding through libjpeg-turbo. It gives the same pixels as OpenCV in three quarters of the
// time, in RGB order. Damaged data is an error here, not a grey area and a line on stderr.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/image.h"
#include "core/status.h"
#include "io/image_header.h"

namespace tessera {

bool IsJpeg(std::span<const std::uint8_t> file);

// From the header; nullopt if it is damaged. Thread-safe.
std::optional<ImageSize> ReadJpegSize(std::span<const std::uint8_t> file);

// Fills `image` (its storage is reused). Grey is copied to all three channels. Images with a side
// over max_side_px are refused before decoding, and so are those of more than a hundred scans: a
// few bytes of a progressive image can ask for as much work as a whole one, thousands of times.
// Errors say what is wrong, without the file name. Thread-safe.
Status DecodeJpeg(std::span<const std::uint8_t> file, int max_side_px, ColourImage& image);

}  // namespace tessera
