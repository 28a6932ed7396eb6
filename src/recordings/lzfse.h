// Apple's LZFSE compression, in which the app Record3D stores depth. A stream is a row of blocks:
// raw bytes, LZVN (lzvn.h), or literals and matches in finite state entropy (lzfse_block.h), and
// an end mark. Written from the published format (github.com/lzfse/lzfse).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace tessera {

// Decodes a stream of exactly bytes.size() bytes; what follows its end mark is ignored. False if
// it is damaged or has another size; `bytes` are then unspecified. The content is not trusted:
// nothing is read or written outside the spans, the time is linear in both sizes, and nothing is
// allocated. Thread-safe.
bool DecodeLzfse(std::span<const std::uint8_t> stream, std::span<std::uint8_t> bytes);

// How many bytes the headers of the stream's blocks promise. nullopt if it is no LZFSE stream, or
// not a whole one. Thread-safe.
std::optional<std::uint64_t> LzfseSize(std::span<const std::uint8_t> stream);

}  // namespace tessera
