// What goes out of memory and comes back as one: a cube of 8 x 8 x 8 blocks. In the file its blocks' keys follow each other.
#pragma once

#include "scan/scan_row.h"

namespace tessera {

inline constexpr int kSectorBlocks = 8;

// Floor, also for negatives.
inline BlockCoord SectorOf(const BlockCoord& block) { return {block.x >> 3, block.y >> 3, block.z >> 3}; }

// BlockKey of the first of its blocks; the others' are the next kSectorKeys - 1.
inline std::int64_t SectorKey(const BlockCoord& sector) {
    return BlockKey({sector.x * kSectorBlocks, sector.y * kSectorBlocks, sector.z * kSectorBlocks});
}
inline constexpr std::int64_t kSectorKeys = kSectorBlocks * kSectorBlocks * kSectorBlocks;
inline std::int64_t SectorKeyOf(std::int64_t block_key) { return block_key & ~(kSectorKeys - 1); }
inline BlockCoord SectorOfKey(std::int64_t sector_key) { return SectorOf(CoordOfKey(sector_key)); }

}  // namespace tessera
