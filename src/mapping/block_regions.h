// Which blocks lie in which region of space, so that a view can look up its candidate blocks. A
// second, coarser hash; BlockMap owns one.
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
    // The block must be present. A region without blocks is removed.
    void Remove(std::int32_t block, const BlockCoord& region);
    // In no particular order. Valid until the next modifying call.
    std::span<const std::int32_t> Blocks(const BlockCoord& region) const;
    void Clear();
    std::size_t bytes() const;  // excluding the regions' block lists

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
