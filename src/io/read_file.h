// A whole regular file in memory, with a limit: lists and images come from outside and are read
// before they are trusted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/status.h"

namespace tessera {

// Fills `bytes` (its storage is reused). Missing, unreadable, not a regular file or larger than
// max_bytes are errors that name the file. Thread-safe for distinct `bytes`.
Status ReadFileBytes(const std::string& path, std::size_t max_bytes,
                     std::vector<std::uint8_t>& bytes);

}  // namespace tessera
