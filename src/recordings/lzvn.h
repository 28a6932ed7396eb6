// LZVN, the byte-oriented one of the two codes in Apple's LZFSE streams (lzfse.h), which Apple's
// encoder uses for what is short. Written from the published format (github.com/lzfse/lzfse).
#pragma once

#include <cstdint>
#include <span>

#include "recordings/lz_output.h"

namespace tessera {

// Decodes the payload of one block, up to and with its end mark. Matches may reach into what the
// output held before. False if it is damaged, or if there is no room. Linear time. Thread-safe.
bool DecodeLzvn(std::span<const std::uint8_t> payload, LzOutput& output);

}  // namespace tessera
