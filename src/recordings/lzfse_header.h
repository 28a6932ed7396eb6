// The header of a block of an LZFSE stream: what it holds and how long it is.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace tessera {

// How literal lengths, match lengths, distances and literals are coded: numbers of symbols and of
// states of the decoder.
inline constexpr std::size_t kLzfseLengthSymbols = 20, kLzfseLengthStates = 64;
inline constexpr std::size_t kLzfseDistanceSymbols = 64, kLzfseDistanceStates = 256;
inline constexpr std::size_t kLzfseLiteralSymbols = 256, kLzfseLiteralStates = 1024;
inline constexpr std::size_t kLzfseSymbols =
    2 * kLzfseLengthSymbols + kLzfseDistanceSymbols + kLzfseLiteralSymbols;

// Of a block in finite state entropy.
struct LzfseTables {
    std::uint32_t literals = 0, matches = 0;
    std::uint32_t literal_bytes = 0, match_bytes = 0;  // of the two parts of the payload
    int literal_spare_bits = 0, match_spare_bits = 0;  // at their ends, 0 to 7
    std::array<std::uint32_t, 4> literal_states{};
    std::uint32_t literal_length_state = 0, match_length_state = 0, distance_state = 0;
    // States of each symbol: of literal lengths, match lengths, distances and literals.
    std::array<std::uint16_t, kLzfseSymbols> frequencies{};
};

enum class LzfseCode { kRaw, kLzvn, kFse, kEnd };

struct LzfseHeader {
    LzfseCode code = LzfseCode::kEnd;
    std::size_t header_bytes = 0;
    std::uint64_t payload_bytes = 0;
    std::uint32_t bytes = 0;  // after decompression
    LzfseTables tables;       // if kFse
};

// Of the block at the start of `stream`. nullopt if it is damaged or cut off, or if the payload is.
std::optional<LzfseHeader> ReadLzfseHeader(std::span<const std::uint8_t> stream);

}  // namespace tessera
