#include "mapping/block_map.h"

#include <algorithm>
#include <atomic>

#include "core/check.h"

namespace tessera {
namespace {

// 2^22 blocks are 2^31 voxels: what a signed 32-bit gather index can reach. At 1 cm voxels that is 2147 cubic
// metres of near-surface space, 21 GB: memory ends before the index does.
constexpr std::size_t kMaxBlocks = std::size_t{1} << 22;

std::atomic<std::uint64_t> last_identity = 0;

std::uint32_t Hash(const BlockCoord& c) { return BlockHash(c.x, c.y, c.z); }

}  // namespace

void BlockMap::Config::Describe(ConfigParameters& p) {
    p.Add("voxel_size_m", voxel_size_m, {0.001, 0.5}, "m",
          "edge of a voxel; halving it costs four times the time and memory and shows finer detail");
    p.Add("truncation_m", truncation_m, {0.002, 2.0}, "m",
          "half width of the band around the surface in which distances are kept; wider tracks faster motion, "
          "thinner keeps thin objects and costs less");
}

Status BlockMap::Config::Validate() const {
    if (truncation_m < 2 * voxel_size_m)
        return Status::Error(fmt::format(
            "mapping.truncation_m: {} m is less than two voxels of {} m; make it at least {} m", truncation_m,
            voxel_size_m, 2 * voxel_size_m));
    return Status::Ok();
}

BlockMap::BlockMap(const Config& config, Layers layers)
    : config_(config),
      layers_(layers),
      field_(kMaxBlocks * kBlockVoxels),
      weight_(kMaxBlocks * kBlockVoxels),
      colour_(kMaxBlocks * kBlockVoxels),
      neighbours_(kMaxBlocks * 8),
      coords_(kMaxBlocks * 4),
      revision_(kMaxBlocks) {
    max_size_ = std::min({field_.max_size() / kBlockVoxels, weight_.max_size() / kBlockVoxels,
                          colour_.max_size() / kBlockVoxels, neighbours_.max_size() / 8,
                          coords_.max_size() / 4, revision_.max_size()});
    Clear();
}

void BlockMap::Clear() {
    field_.Clear();
    weight_.Clear();
    colour_.Clear();
    if (labels_) labels_->Clear();
    neighbours_.Clear();
    coords_.Clear();
    revision_.Clear();
    table_.assign(1024, 0);
    region_table_.assign(256, 0);
    regions_.clear();
    size_ = 1;
    identity_ = ++last_identity;
    InitialiseBlock(kUnknownBlock, {kBlockLimit, kBlockLimit, kBlockLimit});
}

void BlockMap::EnableLabels() {
    TESSERA_CHECK(size_ == 1, "labels enabled in a map of {} blocks", size_);
    labels_.emplace(kMaxBlocks * kBlockVoxels);
    max_size_ = std::min(max_size_, labels_->max_size() / kBlockVoxels);
}

void BlockMap::InitialiseBlock(BlockId id, const BlockCoord& c) {
    std::fill_n(field(id), kBlockVoxels, kUnknownField);
    if (layers_ == Layers::kAll || id == kUnknownBlock) std::fill_n(colour(id), kBlockVoxels, kNoColour);
    std::int32_t* coords = coords_.data() + 4 * static_cast<std::size_t>(id);
    coords[0] = c.x;
    coords[1] = c.y;
    coords[2] = c.z;
}

BlockMap::View BlockMap::view() const {
    return {field_.data(),
            neighbours_.data(),
            table_.data(),
            coords_.data(),
            static_cast<std::uint32_t>(table_.size() - 1),
            static_cast<float>(config_.voxel_size_m),
            static_cast<float>(config_.truncation_m)};
}

BlockCoord BlockMap::coord(BlockId id) const {
    const std::int32_t* c = coords_.data() + 4 * static_cast<std::size_t>(id);
    return {c[0], c[1], c[2]};
}

BlockId BlockMap::Find(const BlockCoord& c) const {
    const std::uint32_t mask = static_cast<std::uint32_t>(table_.size() - 1);
    for (std::uint32_t slot = Hash(c) & mask;; slot = (slot + 1) & mask) {
        const BlockId id = table_[slot];
        if (id == kUnknownBlock || coord(id) == c) return id;
    }
}

BlockId BlockMap::Allocate(const BlockCoord& c) {
    if (!InLimits(c)) return kUnknownBlock;
    if (const BlockId id = Find(c); id != kUnknownBlock) return id;
    if (static_cast<std::size_t>(size_) >= max_size_) return kUnknownBlock;
    if (2 * static_cast<std::size_t>(size_) >= table_.size()) GrowTable();
    const BlockId id = size_++;
    InitialiseBlock(id, c);
    InsertIntoTable(id);
    LinkNeighbours(id, c);
    FindOrAddRegion(RegionOf(c))->blocks.push_back(id);
    return id;
}

void BlockMap::InsertIntoTable(BlockId id) {
    const std::uint32_t mask = static_cast<std::uint32_t>(table_.size() - 1);
    std::uint32_t slot = Hash(coord(id)) & mask;
    while (table_[slot] != 0) slot = (slot + 1) & mask;
    table_[slot] = id;
}

void BlockMap::GrowTable() {
    table_.assign(2 * table_.size(), 0);
    for (BlockId id = 1; id < size_; ++id) InsertIntoTable(id);
}

// Enters the new block at every block that has it as a positive neighbour, and its own eight.
void BlockMap::LinkNeighbours(BlockId id, const BlockCoord& c) {
    for (int slot = 0; slot < 8; ++slot) {
        const int dx = slot & 1, dy = slot >> 1 & 1, dz = slot >> 2;
        neighbours_[8 * static_cast<std::size_t>(id) + slot] = Find({c.x + dx, c.y + dy, c.z + dz});
        if (const BlockId before = Find({c.x - dx, c.y - dy, c.z - dz}); before != kUnknownBlock)
            neighbours_[8 * static_cast<std::size_t>(before) + slot] = id;
    }
}

BlockId BlockMap::neighbour(BlockId id, int dx, int dy, int dz) const {
    const BlockCoord c = coord(id);
    return Find({c.x + dx, c.y + dy, c.z + dz});
}

BlockCoord BlockMap::RegionOf(const BlockCoord& block) {
    constexpr int kShift = 2;  // log2(kRegionBlocks); arithmetic shift is floor
    return {block.x >> kShift, block.y >> kShift, block.z >> kShift};
}

std::int32_t BlockMap::FindRegion(const BlockCoord& region) const {
    const std::uint32_t mask = static_cast<std::uint32_t>(region_table_.size() - 1);
    for (std::uint32_t slot = Hash(region) & mask;; slot = (slot + 1) & mask) {
        const std::int32_t index = region_table_[slot] - 1;
        if (index < 0 || regions_[static_cast<std::size_t>(index)].coord == region) return index;
    }
}

std::span<const BlockId> BlockMap::BlocksInRegion(const BlockCoord& region) const {
    const std::int32_t index = FindRegion(region);
    if (index < 0) return {};
    return regions_[static_cast<std::size_t>(index)].blocks;
}

BlockMap::Region* BlockMap::FindOrAddRegion(const BlockCoord& region) {
    if (const std::int32_t index = FindRegion(region); index >= 0)
        return &regions_[static_cast<std::size_t>(index)];
    regions_.push_back({region, {}});
    const auto insert = [this](std::size_t index) {
        const std::uint32_t mask = static_cast<std::uint32_t>(region_table_.size() - 1);
        std::uint32_t slot = Hash(regions_[index].coord) & mask;
        while (region_table_[slot] != 0) slot = (slot + 1) & mask;
        region_table_[slot] = static_cast<std::int32_t>(index) + 1;
    };
    if (2 * regions_.size() >= region_table_.size()) {
        region_table_.assign(2 * region_table_.size(), 0);
        for (std::size_t i = 0; i < regions_.size(); ++i) insert(i);
    } else {
        insert(regions_.size() - 1);
    }
    return &regions_.back();
}

std::size_t BlockMap::bytes() const {
    const std::size_t per_voxel =
        sizeof(FieldWord) + (layers_ == Layers::kAll ? sizeof(std::uint16_t) + sizeof(ColourWord) : 0) +
        (labels_ ? sizeof(VoxelLabel) : 0);
    const std::size_t per_block = kBlockVoxels * per_voxel + (8 + 4 + 1) * sizeof(std::int32_t) + sizeof(BlockId);
    return static_cast<std::size_t>(size_) * per_block + table_.size() * sizeof(std::int32_t) +
           regions_.size() * sizeof(Region) + region_table_.size() * sizeof(std::int32_t);
}

double BlockMap::bytes_per_voxel() const {
    return static_cast<double>(bytes()) / (static_cast<double>(size_) * kBlockVoxels);
}

}  // namespace tessera
