// What changed in a map, as a message: whoever must read the map while another thread writes it keeps a copy of its
// field and brings that up to date.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mapping/block_map.h"

namespace tessera {

// The field of changed blocks and the coordinates of new ones; weights and colours stay with the map's owner.
struct MapDelta {
    std::uint32_t revision = 0;
    BlockId first_new = 1;                // new blocks have the ids from here on, in this order
    std::vector<BlockCoord> new_blocks;
    std::vector<BlockId> changed;         // whose field follows, new blocks included
    std::vector<FieldWord> field;         // kBlockVoxels for each of them

    std::size_t bytes() const;
};

// `first_new`: the map's size when the last delta was taken. Storage is used again. Nobody may write the map meanwhile.
void CollectDelta(const BlockMap& map, BlockId first_new, std::span<const BlockId> changed, std::uint32_t revision,
                  MapDelta& delta);

// The whole field at once, under the same ids.
std::unique_ptr<BlockMap> CopyField(const BlockMap& map);

// Brings `copy` up to date; deltas are to be applied in the order in which they were taken, each once, from an empty
// map on.
void ApplyDelta(const MapDelta& delta, BlockMap& copy);

}  // namespace tessera
