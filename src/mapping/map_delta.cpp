#include "mapping/map_delta.h"

#include <tbb/parallel_for.h>

#include <cstring>
#include <limits>

#include "core/check.h"

namespace tessera {
namespace {

constexpr std::size_t kFieldBytes = kBlockVoxels * sizeof(FieldWord);
constexpr std::size_t kGrain = 64;

template <class Copy>
void ForEachChanged(std::size_t count, const Copy& copy) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) copy(i);
    });
}

}  // namespace

std::size_t MapDelta::bytes() const {
    return new_blocks.capacity() * sizeof(BlockCoord) + changed.capacity() * sizeof(BlockId) +
           field.capacity() * sizeof(FieldWord);
}

void CollectDelta(const BlockMap& map, BlockId first_new, std::span<const BlockId> changed, std::uint32_t revision,
                  MapDelta& delta) {
    delta.revision = revision;
    delta.first_new = first_new;
    delta.new_blocks.clear();
    for (BlockId id = first_new; id < map.size(); ++id) delta.new_blocks.push_back(map.coord(id));
    delta.changed.assign(changed.begin(), changed.end());
    delta.field.resize(changed.size() * kBlockVoxels);
    ForEachChanged(changed.size(), [&](std::size_t i) {
        std::memcpy(delta.field.data() + i * kBlockVoxels, map.field(changed[i]), kFieldBytes);
    });
}

std::unique_ptr<BlockMap> CopyField(const BlockMap& map) {
    constexpr std::uint32_t kNoDeltas = std::numeric_limits<std::uint32_t>::max();
    auto copy = std::make_unique<BlockMap>(map.config(), BlockMap::Layers::kFieldOnly);
    for (BlockId id = 1; id < map.size(); ++id) {
        copy->Allocate(map.coord(id));
        std::memcpy(copy->field(id), map.field(id), kFieldBytes);
        copy->MarkChanged(id, kNoDeltas);
    }
    return copy;
}

void ApplyDelta(const MapDelta& delta, BlockMap& copy) {
    TESSERA_CHECK(delta.first_new == copy.size(), "a delta from block {} on for a copy of {} blocks", delta.first_new,
                  copy.size());
    for (const BlockCoord& c : delta.new_blocks) copy.Allocate(c);
    TESSERA_CHECK(copy.size() == delta.first_new + static_cast<BlockId>(delta.new_blocks.size()),
                  "the copy has {} blocks after a delta that ends with {}", copy.size(),
                  delta.first_new + static_cast<BlockId>(delta.new_blocks.size()));
    ForEachChanged(delta.changed.size(), [&](std::size_t i) {
        std::memcpy(copy.field(delta.changed[i]), delta.field.data() + i * kBlockVoxels, kFieldBytes);
        copy.MarkChanged(delta.changed[i], delta.revision);
    });
}

}  // namespace tessera
