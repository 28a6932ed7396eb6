// Writes arrays in NumPy's .npy format, version 1.0, which numpy.load and most robot software read.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/status.h"

namespace tessera {

// `values` of shape (depth, height, width), the last index fastest, little endian. Writes to a
// temporary file and renames it. Errors: write errors, which name the file. Thread-safe for
// different paths. Source: numpy.lib.format.
Status WriteNpy(const std::string& path, std::span<const float> values, int depth, int height,
                int width);
Status WriteNpy(const std::string& path, std::span<const std::uint8_t> values, int depth,
                int height, int width);

}  // namespace tessera
