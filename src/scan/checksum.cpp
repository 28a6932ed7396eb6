#include "scan/checksum.h"

#include <array>
#include <cstring>

namespace tessera {
namespace {

// tables[k][b] is the checksum of byte b followed by k zero bytes. It allows processing eight bytes
// at once.
using Tables = std::array<std::array<std::uint64_t, 256>, 8>;

constexpr Tables MakeTables() {
    constexpr std::uint64_t kReflected = 0xc96c5795d7870f42u;
    Tables tables{};
    for (std::uint64_t byte = 0; byte < 256; ++byte) {
        std::uint64_t crc = byte;
        for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? crc >> 1 ^ kReflected : crc >> 1;
        tables[0][byte] = crc;
    }
    for (std::size_t k = 1; k < 8; ++k)
        for (std::size_t byte = 0; byte < 256; ++byte)
            tables[k][byte] = tables[k - 1][byte] >> 8 ^ tables[0][tables[k - 1][byte] & 0xff];
    return tables;
}

constexpr Tables kTables = MakeTables();

}  // namespace

std::uint64_t Crc64(std::span<const std::uint8_t> bytes, std::uint64_t crc) {
    crc = ~crc;
    while (bytes.size() >= 8) {
        std::uint64_t word;
        std::memcpy(&word, bytes.data(), 8);
        word ^= crc;
        crc = 0;
        for (std::size_t i = 0; i < 8; ++i) crc ^= kTables[7 - i][word >> (8 * i) & 0xff];
        bytes = bytes.subspan(8);
    }
    for (const std::uint8_t byte : bytes) crc = crc >> 8 ^ kTables[0][(crc ^ byte) & 0xff];
    return ~crc;
}

}  // namespace tessera
