// What goes out of memory and comes back as one: a cube of 8 x 8 x 8 blocks. In the file its
// blocks' keys follow each other.
#pragma once

#include "scan/scan_row.h"

namespace tessera {

inline constexpr int kCubeBlocks = 8;

// Floor, also for negatives.
inline BlockCoord CubeOf(const BlockCoord& block) {
    return {block.x >> 3, block.y >> 3, block.z >> 3};
}

// BlockKey of the first of its blocks; the others' are the next kCubeKeys - 1.
inline std::int64_t CubeKey(const BlockCoord& cube) {
    return BlockKey({cube.x * kCubeBlocks, cube.y * kCubeBlocks, cube.z * kCubeBlocks});
}
inline constexpr std::int64_t kCubeKeys = kCubeBlocks * kCubeBlocks * kCubeBlocks;
inline std::int64_t CubeKeyOf(std::int64_t block_key) { return block_key & ~(kCubeKeys - 1); }
inline BlockCoord CubeOfKey(std::int64_t cube_key) { return CubeOf(CoordOfKey(cube_key)); }

}  // namespace tessera
