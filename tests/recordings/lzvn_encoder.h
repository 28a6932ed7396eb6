// LZVN payloads for the test encoder of LZFSE streams.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "recordings/lz_steps.h"

namespace tessera {

// `literals` are those of all steps in a row.
std::vector<std::uint8_t> EncodeLzvn(std::span<const LzStep> steps,
                                     std::span<const std::uint8_t> literals);

}  // namespace tessera
