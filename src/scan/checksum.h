// CRC-64/XZ (ECMA-182, reflected). Detects every burst error of up to 64 bits, and all but one in
// 2^64 of other errors.
#pragma once

#include <cstdint>
#include <span>

namespace tessera {

// `crc` is the checksum of the preceding bytes. Thread-safe.
std::uint64_t Crc64(std::span<const std::uint8_t> bytes, std::uint64_t crc = 0);

}  // namespace tessera
