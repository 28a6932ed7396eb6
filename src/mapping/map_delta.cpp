#include "mapping/map_delta.h"

#include <tbb/parallel_for.h>

#include <cstring>
#include <limits>

#include "core/check.h"
#include "core/refill.h"

namespace tessera {
namespace {

constexpr std::size_t kFieldBytes = kBlockVoxels * sizeof(FieldWord);
constexpr std::size_t kWeightBytes = kBlockVoxels * sizeof(std::uint16_t);
constexpr std::size_t kColourBytes = kBlockVoxels * sizeof(ColourWord);
constexpr std::size_t kGrain = 64;

template <class Copy>
void ForEachChanged(std::size_t count, const Copy& copy) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) copy(i);
    });
}

}  // namespace

std::size_t MapDelta::bytes() const {
    return blocks.capacity() * sizeof(BlockChange) + changed.capacity() * sizeof(BlockId) +
           field.capacity() * sizeof(FieldWord) + colour.capacity() * sizeof(ColourWord);
}

void CollectDelta(const BlockMap& map, BlockMap::Layers layers, std::span<const BlockChange> blocks,
                  std::span<const BlockId> changed, std::uint32_t revision, MapDelta& delta) {
    const bool colours = layers != BlockMap::Layers::kFieldOnly;
    delta.revision = revision;
    delta.blocks.assign(blocks.begin(), blocks.end());
    delta.changed.assign(changed.begin(), changed.end());
    Refill(changed.size() * kBlockVoxels, delta.field);
    Refill(colours ? changed.size() * kBlockVoxels : 0, delta.colour);
    ForEachChanged(changed.size(), [&](std::size_t i) {
        const std::size_t at = i * kBlockVoxels;
        std::memcpy(delta.field.data() + at, map.field(changed[i]), kFieldBytes);
        if (colours) std::memcpy(delta.colour.data() + at, map.colour(changed[i]), kColourBytes);
    });
}

void CopyVoxels(const BlockMap& map, BlockId id, BlockMap& copy, BlockId to) {
    std::memcpy(copy.field(to), map.field(id), kFieldBytes);
    if (copy.has_colours()) std::memcpy(copy.colour(to), map.colour(id), kColourBytes);
    if (copy.layers() == BlockMap::Layers::kAll)
        std::memcpy(copy.weight(to), map.weight(id), kWeightBytes);
}

std::unique_ptr<BlockMap> CopyLayers(const BlockMap& map, BlockMap::Layers layers) {
    constexpr std::uint32_t kNoDeltas = std::numeric_limits<std::uint32_t>::max();
    auto copy = std::make_unique<BlockMap>(map.config(), layers);
    for (BlockId id = 1; id < map.size(); ++id) {
        if (map.IsFree(id)) continue;
        copy->AllocateAs(id, map.coord(id));
        CopyVoxels(map, id, *copy, id);
        copy->MarkChanged(id, kNoDeltas);
    }
    return copy;
}

void ApplyDelta(const MapDelta& delta, BlockMap& copy) {
    for (const BlockChange& change : delta.blocks) {
        const BlockId id = change.released ? copy.Find(change.coord) : copy.Allocate(change.coord);
        TESSERA_CHECK(id == change.id, "block {} of the map is block {} in the copy", change.id,
                      id);
        if (change.released) copy.Release(id);
    }
    ForEachChanged(delta.changed.size(), [&](std::size_t i) {
        const std::size_t at = i * kBlockVoxels;
        std::memcpy(copy.field(delta.changed[i]), delta.field.data() + at, kFieldBytes);
        if (copy.has_colours())
            std::memcpy(copy.colour(delta.changed[i]), delta.colour.data() + at, kColourBytes);
        copy.MarkChanged(delta.changed[i], delta.revision);
    });
}

}  // namespace tessera
