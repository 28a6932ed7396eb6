// The unit of paging: a cube of 8 x 8 x 8 blocks. The keys of its blocks are consecutive, also in
// the file.
#pragma once

#include "scan/scan_row.h"

namespace tessera {

inline constexpr int kCubeBlocks = 8;

// Rounds down, also for negative coordinates.
inline BlockCoord CubeOf(const BlockCoord& block) {
    return {block.x >> 3, block.y >> 3, block.z >> 3};
}

// The BlockKey of the cube's first block. The other blocks have the next kCubeKeys - 1 keys.
inline std::int64_t CubeKey(const BlockCoord& cube) {
    return BlockKey({cube.x * kCubeBlocks, cube.y * kCubeBlocks, cube.z * kCubeBlocks});
}
inline constexpr std::int64_t kCubeKeys = kCubeBlocks * kCubeBlocks * kCubeBlocks;
inline std::int64_t CubeKeyOf(std::int64_t block_key) { return block_key & ~(kCubeKeys - 1); }
inline BlockCoord CubeOfKey(std::int64_t cube_key) { return CubeOf(CoordOfKey(cube_key)); }

}  // namespace tessera
