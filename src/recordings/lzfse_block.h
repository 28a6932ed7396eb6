// The blocks of an LZFSE stream that hold literals and matches in finite state entropy (FSE).
#pragma once

#include <cstdint>
#include <span>

#include "recordings/lz_output.h"
#include "recordings/lzfse_header.h"

namespace tessera {

// Decodes the payload of one block. Matches may reach into what the output held before. False if
// it is damaged, or if there is no room. Linear time. Thread-safe.
bool DecodeLzfseBlock(const LzfseTables& tables, std::span<const std::uint8_t> payload,
                      LzOutput& output);

}  // namespace tessera
