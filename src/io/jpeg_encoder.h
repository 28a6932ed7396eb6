// JPEG encoding for recordings. One core, 640x480: 1.4 ms.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"
#include "core/status.h"

namespace tessera {

// Of recordings and of single pictures.
inline constexpr int kFineJpegQuality = 95;

// Into `file` (its storage is reused), `quality` 1 to 100, colour at full resolution. The image
// must not be empty. Errors say what libjpeg refuses (a side of more than 65500 pixels).
// Thread-safe for distinct files.
Status EncodeJpeg(const ColourImage& image, int quality, std::vector<std::uint8_t>& file);

}  // namespace tessera
