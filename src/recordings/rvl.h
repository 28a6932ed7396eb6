// RVL, the lossless code for depth images of compressed_depth_image_transport. Written from the
// publication: Wilson, "Fast lossless depth image compression", ISS 2017.
#pragma once

#include <cstdint>
#include <span>

namespace tessera {

// Decodes `code` into all of `pixels`, row by row. False if the code ends too early or is damaged;
// `pixels` is unspecified then. Linear time. Thread-safe.
bool DecodeRvl(std::span<const std::uint8_t> code, std::span<std::uint16_t> pixels);

}  // namespace tessera
