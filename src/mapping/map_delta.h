// What changed in a map, as a message: whoever must read the map while another thread writes it
// keeps a copy of its field and brings that up to date.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mapping/block_map.h"

namespace tessera {

// One block that came or went; a map in which the same ones came and went in the same order gives
// it the same id.
struct BlockChange {
    BlockId id = kUnknownBlock;
    bool released = false;
    BlockCoord coord;
};

// The field of changed blocks, and which blocks came and went; weights and colours stay with the
// map's owner.
struct MapDelta {
    std::uint32_t revision = 0;
    std::vector<BlockChange> blocks;  // in order
    std::vector<BlockId> changed;     // whose field follows, new blocks included
    std::vector<FieldWord> field;     // kBlockVoxels for each of them

    std::size_t bytes() const;
};

// `blocks`: what came and went since the last delta was taken. Storage is used again. Nobody may
// write the map meanwhile.
void CollectDelta(const BlockMap& map, std::span<const BlockChange> blocks,
                  std::span<const BlockId> changed, std::uint32_t revision, MapDelta& delta);

// All of a map from which nothing was released yet, for a copy that is empty.
void CollectWhole(const BlockMap& map, std::uint32_t revision, MapDelta& delta);

// The whole field at once, under the same ids.
std::unique_ptr<BlockMap> CopyField(const BlockMap& map);

// Brings `copy` up to date; deltas are to be applied in the order in which they were taken, each
// once, from an empty map on.
void ApplyDelta(const MapDelta& delta, BlockMap& copy);

}  // namespace tessera
