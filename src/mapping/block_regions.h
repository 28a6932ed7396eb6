// Which blocks lie in which region of space, so that a view looks up what may be in it. A second,
// coarser hash beside BlockMap's, which owns one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mapping/voxel.h"

namespace tessera {

// Owner thread only; any number of readers while nobody writes.
class BlockRegions {
  public:
    BlockRegions() { Clear(); }

    void Add(std::int32_t block, const BlockCoord& region);
    // The block must be there. A region without blocks goes.
    void Remove(std::int32_t block, const BlockCoord& region);
    // In no particular order; valid until the next call that changes anything.
    std::span<const std::int32_t> Blocks(const BlockCoord& region) const;
    void Clear();
    std::size_t bytes() const;  // without the regions' lists of blocks

  private:
    struct Region {
        BlockCoord coord;
        std::vector<std::int32_t> blocks;
    };
    std::uint32_t SlotOf(const BlockCoord& region) const;
    void Grow();

    std::vector<std::int32_t> table_;  // index + 1, 0 = empty
    std::vector<Region> regions_;
};

}  // namespace tessera
