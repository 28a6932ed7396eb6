// The hot loop of fusion behind plain pointers: updates whole blocks from one frame. Compiled twice
// (portable, AVX2); integrator.cpp selects the version. No Eigen here.
#pragma once

#include <cstdint>

#include "mapping/fusion_arguments.h"

namespace tessera {

namespace baseline {
void FuseBlocks(const FusionArguments& arguments, const std::int32_t* blocks, std::int32_t count);
}
namespace avx2 {
void FuseBlocks(const FusionArguments& arguments, const std::int32_t* blocks, std::int32_t count);
}

}  // namespace tessera
