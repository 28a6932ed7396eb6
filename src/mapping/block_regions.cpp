#include "mapping/block_regions.h"

#include <algorithm>

#include "mapping/hash_slots.h"

namespace tessera {
namespace {

constexpr std::size_t kFirstSlots = 256;

}  // namespace

void BlockRegions::Clear() {
    table_.assign(kFirstSlots, 0);
    regions_.clear();
}

// The table slot of the region, or the empty slot where it would go.
std::uint32_t BlockRegions::SlotOf(const BlockCoord& region) const {
    const std::uint32_t mask = static_cast<std::uint32_t>(table_.size() - 1);
    for (std::uint32_t slot = BlockHash(region) & mask;; slot = (slot + 1) & mask) {
        const std::int32_t index = table_[slot] - 1;
        if (index < 0 || regions_[static_cast<std::size_t>(index)].coord == region) return slot;
    }
}

std::span<const std::int32_t> BlockRegions::Blocks(const BlockCoord& region) const {
    const std::int32_t index = table_[SlotOf(region)] - 1;
    if (index < 0) return {};
    return regions_[static_cast<std::size_t>(index)].blocks;
}

void BlockRegions::Grow() {
    table_.assign(2 * table_.size(), 0);
    for (std::size_t i = 0; i < regions_.size(); ++i)
        table_[SlotOf(regions_[i].coord)] = static_cast<std::int32_t>(i) + 1;
}

void BlockRegions::Add(std::int32_t block, const BlockCoord& region) {
    if (2 * (regions_.size() + 1) >= table_.size()) Grow();
    std::int32_t& entry = table_[SlotOf(region)];
    if (entry == 0) {
        regions_.push_back({region, {}});
        entry = static_cast<std::int32_t>(regions_.size());
    }
    regions_[static_cast<std::size_t>(entry) - 1].blocks.push_back(block);
}

void BlockRegions::Remove(std::int32_t block, const BlockCoord& region) {
    const std::uint32_t slot = SlotOf(region);
    const auto index = static_cast<std::size_t>(table_[slot] - 1);
    std::vector<std::int32_t>& blocks = regions_[index].blocks;
    *std::ranges::find(blocks, block) = blocks.back();
    blocks.pop_back();
    if (!blocks.empty()) return;
    // Move the last region into the gap.
    const std::uint32_t last_slot = SlotOf(regions_.back().coord);
    std::swap(regions_[index], regions_.back());
    table_[last_slot] = static_cast<std::int32_t>(index) + 1;
    EraseSlot(table_, slot, [this](std::int32_t entry) {
        return BlockHash(regions_[static_cast<std::size_t>(entry) - 1].coord);
    });
    regions_.pop_back();
}

std::size_t BlockRegions::bytes() const {
    return regions_.size() * sizeof(Region) + table_.size() * sizeof(std::int32_t);
}

}  // namespace tessera
