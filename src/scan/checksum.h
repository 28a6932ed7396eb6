// CRC-64/XZ (ECMA-182, reflected): finds every burst of up to 64 wrong bits, and of other damage
// all but one in 2^64.
#pragma once

#include <cstdint>
#include <span>

namespace tessera {

// Goes on from `crc`, the checksum of what came before. Thread-safe.
std::uint64_t Crc64(std::span<const std::uint8_t> bytes, std::uint64_t crc = 0);

}  // namespace tessera
