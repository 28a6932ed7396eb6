// The changes of a map, as a message. A thread that must read the map while another writes it keeps
// a copy of the field and updates the copy from these messages.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mapping/block_map.h"

namespace tessera {

// One block that was allocated or released. Two maps with the same changes in the same order use
// the same ids.
struct BlockChange {
    BlockId id = kUnknownBlock;
    bool released = false;
    BlockCoord coord;
};

// The field of changed blocks, their colours if asked for, and the blocks that were allocated or
// released. Weights stay with the map's owner.
struct MapDelta {
    std::uint32_t revision = 0;
    std::vector<BlockChange> blocks;  // in order
    std::vector<BlockId> changed;     // blocks whose field follows, including new ones
    std::vector<FieldWord> field;     // kBlockVoxels for each changed block
    std::vector<ColourWord> colour;   // the same, or empty

    std::size_t bytes() const;
};

// `layers` are those of the copy, `blocks` the blocks allocated or released since the last delta.
// Reuses the storage of `delta`. Nobody may write the map meanwhile.
void CollectDelta(const BlockMap& map, BlockMap::Layers layers, std::span<const BlockChange> blocks,
                  std::span<const BlockId> changed, std::uint32_t revision, MapDelta& delta);

// Copies these layers of the whole map at once, with the same ids, but no labels.
std::unique_ptr<BlockMap> CopyLayers(const BlockMap& map, BlockMap::Layers layers);

// Copies the layers that `copy` has, but no labels, from one block to another.
void CopyVoxels(const BlockMap& map, BlockId id, BlockMap& copy, BlockId to);

// Brings `copy` up to date. Apply every delta exactly once, in the order of collection, starting
// from an empty map or from CopyLayers.
void ApplyDelta(const MapDelta& delta, BlockMap& copy);

}  // namespace tessera
