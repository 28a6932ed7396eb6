// The size of an encoded image from its header alone, so that nothing large is decoded unseen.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace tessera {

struct ImageSize {
    int width = 0, height = 0;  // pixels

    bool operator==(const ImageSize&) const = default;
};

// Of a PNG, JPEG, PNM (.ppm, .pgm), BMP or TIFF image. nullopt for any other file, and for a
// damaged header.
std::optional<ImageSize> ReadImageSize(std::span<const std::uint8_t> file);

}  // namespace tessera
