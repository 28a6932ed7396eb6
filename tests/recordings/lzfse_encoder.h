// An encoder for LZFSE streams, so that tests have recordings. It is written from the published
// format alone and shares nothing with the decoder: no tables, no header layout, no code. It uses
// every kind of block and every opcode, and does not try to be small or fast.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tessera {

enum class LzfseBlock { kRaw, kLzvn, kWide, kPacked };  // bvx-, bvxn, bvx1, bvx2

// Blocks of up to `most_steps` literal runs and matches each, of these kinds in turn.
std::vector<std::uint8_t> EncodeLzfse(std::span<const std::uint8_t> bytes,
                                      const std::vector<LzfseBlock>& kinds,
                                      std::size_t most_steps = 5000);

}  // namespace tessera
