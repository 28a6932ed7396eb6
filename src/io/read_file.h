// Reads a whole regular file into memory, up to a limit. For lists and images from outside, whose
// content is not trusted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/status.h"

namespace tessera {

// Fills `bytes` (its storage is reused). A file that is missing, unreadable, not a regular file or
// larger than max_bytes is an error that names the file. Thread-safe for distinct `bytes`.
Status ReadFileBytes(const std::string& path, std::size_t max_bytes,
                     std::vector<std::uint8_t>& bytes);

}  // namespace tessera
