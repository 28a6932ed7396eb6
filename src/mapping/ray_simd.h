// The hot loop of the ray caster behind plain pointers: casts tiles of pixels, one ray per SIMD
// lane. Compiled twice (portable, AVX2); ray_caster.cpp selects the version. No Eigen here.
#pragma once

#include <cstdint>

#include "mapping/ray_arguments.h"

namespace tessera {

// Casts `count` tiles.
namespace baseline {
void CastTiles(const RayArguments& arguments, const RayTile* tiles, std::int32_t count);
}
namespace avx2 {
void CastTiles(const RayArguments& arguments, const RayTile* tiles, std::int32_t count);
}

}  // namespace tessera
