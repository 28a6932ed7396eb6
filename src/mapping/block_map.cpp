#include "mapping/block_map.h"

#include <algorithm>
#include <atomic>
#include <functional>

#include "core/check.h"
#include "mapping/hash_slots.h"

namespace tessera {
namespace {

// 2^22 blocks are 2^31 voxels: the range of a signed 32-bit gather index. At 1 cm voxels that is
// 2147 cubic metres of near-surface space, or 21 GB: memory runs out before the index.
constexpr std::size_t kMaxBlocks = std::size_t{1} << 22;

std::atomic<std::uint64_t> last_identity = 0;

}  // namespace

void BlockMap::Config::Describe(ConfigParameters& p) {
    p.Add("voxel_size_m", voxel_size_m, {0.001, 0.5}, "m",
          "edge length of a voxel; halving it gives finer detail but costs four times the time and "
          "memory");
    p.Add("truncation_m", truncation_m, {0.002, 2.0}, "m",
          "half width of the band around the surface in which distances are stored; a wider band "
          "tracks faster motion, a narrower one preserves thin objects and costs less");
    p.Add(
        "band_per_m", band_per_m, {0.0, 10.0}, "1/m",
        "around a surface z metres away the band's half width is this times z squared, where that "
        "is more than truncation_m, and four times truncation_m at most; 0: a run measures it "
        "(band_sigmas)");
}

TruncationBand BlockMap::Config::band() const {
    return {static_cast<float>(truncation_m), static_cast<float>(band_per_m),
            static_cast<float>(range_m())};
}

Status BlockMap::Config::Validate() const {
    if (truncation_m < 2 * voxel_size_m)
        return Status::Error(fmt::format(
            "mapping.truncation_m: {} m is less than two voxels of {} m; make it at least {} m",
            truncation_m, voxel_size_m, 2 * voxel_size_m));
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
    regions_.Clear();
    free_.clear();
    size_ = 1;
    next_number_ = 1;
    identity_ = ++last_identity;
    InitialiseBlock(kUnknownBlock, {kBlockLimit, kBlockLimit, kBlockLimit}, 0);
}

void BlockMap::EnableLabels() {
    TESSERA_CHECK(!labels_, "labels enabled twice");
    labels_.emplace(kMaxBlocks * kBlockVoxels);
    max_size_ = std::min(max_size_, labels_->max_size() / kBlockVoxels);
}

void BlockMap::InitialiseBlock(BlockId id, const BlockCoord& c, std::int32_t number) {
    std::fill_n(field(id), kBlockVoxels, kUnknownField);
    if (has_colours() || id == kUnknownBlock) std::fill_n(colour(id), kBlockVoxels, kNoColour);
    std::int32_t* coords = coords_.data() + 4 * static_cast<std::size_t>(id);
    coords[0] = c.x;
    coords[1] = c.y;
    coords[2] = c.z;
    coords[3] = number;
}

BlockMapView BlockMap::view() const {
    return {field_.data(),
            neighbours_.data(),
            table_.data(),
            coords_.data(),
            static_cast<std::uint32_t>(table_.size() - 1),
            static_cast<float>(config_.voxel_size_m),
            config_.band()};
}

BlockCoord BlockMap::coord(BlockId id) const {
    const std::int32_t* c = coords_.data() + 4 * static_cast<std::size_t>(id);
    return {c[0], c[1], c[2]};
}

BlockId BlockMap::Find(const BlockCoord& c) const {
    const std::uint32_t mask = static_cast<std::uint32_t>(table_.size() - 1);
    for (std::uint32_t slot = BlockHash(c) & mask;; slot = (slot + 1) & mask) {
        const BlockId id = table_[slot];
        if (id == kUnknownBlock || coord(id) == c) return id;
    }
}

BlockId BlockMap::Allocate(const BlockCoord& c, std::int32_t number) {
    if (!InLimits(c)) return kUnknownBlock;
    if (const BlockId id = Find(c); id != kUnknownBlock) return id;
    const BlockId id = TakeId();
    if (id == kUnknownBlock) return id;
    Enter(id, c, number);
    return id;
}

void BlockMap::Enter(BlockId id, const BlockCoord& c, std::int32_t number) {
    next_number_ = std::max(next_number_, number + 1);
    InitialiseBlock(id, c, number);
    InsertIntoTable(id);
    LinkNeighbours(id, c);
    regions_.Add(id, RegionOf(c));
}

void BlockMap::AllocateAs(BlockId id, const BlockCoord& c) {
    TESSERA_CHECK(id >= size_ && static_cast<std::size_t>(id) < max_size_ && InLimits(c) &&
                      Find(c) == kUnknownBlock,
                  "cannot allocate block {} in a map of {}", id, size_);
    for (; size_ < id; ++size_) {
        InitialiseBlock(size_, {kBlockLimit, kBlockLimit, kBlockLimit}, 0);
        free_.push_back(size_);
        std::ranges::push_heap(free_, std::greater());
    }
    ++size_;
    while (2 * static_cast<std::size_t>(size_) > table_.size()) GrowTable();
    Enter(id, c, next_number_);
}

void BlockMap::NumberAnew() {
    next_number_ = 1;
    for (BlockId id = 1; id < size_; ++id)
        if (!IsFree(id)) coords_.data()[4 * static_cast<std::size_t>(id) + 3] = next_number_++;
}

BlockId BlockMap::TakeId() {
    if (!free_.empty()) {
        std::ranges::pop_heap(free_, std::greater());
        const BlockId id = free_.back();
        free_.pop_back();
        return id;
    }
    if (static_cast<std::size_t>(size_) >= max_size_) return kUnknownBlock;
    if (2 * static_cast<std::size_t>(size_) >= table_.size()) GrowTable();
    return size_++;
}

void BlockMap::Release(BlockId id) {
    TESSERA_CHECK(id > kUnknownBlock && id < size_ && !IsFree(id),
                  "cannot release block {} in a map of {}", id, size_);
    const BlockCoord c = coord(id);
    const std::uint32_t mask = static_cast<std::uint32_t>(table_.size() - 1);
    std::uint32_t slot = BlockHash(c) & mask;
    while (table_[slot] != id) slot = (slot + 1) & mask;
    EraseSlot(table_, slot, [this](std::int32_t other) { return BlockHash(coord(other)); });
    regions_.Remove(id, RegionOf(c));
    UnlinkNeighbours(id, c);
    InitialiseBlock(id, {kBlockLimit, kBlockLimit, kBlockLimit}, 0);
    if (layers_ == Layers::kAll) std::fill_n(weight(id), kBlockVoxels, std::uint16_t{0});
    if (labels_) std::fill_n(label(id), kBlockVoxels, VoxelLabel{});
    revision_[static_cast<std::size_t>(id)] = 0;
    free_.push_back(id);
    std::ranges::push_heap(free_, std::greater());
}

void BlockMap::InsertIntoTable(BlockId id) {
    const std::uint32_t mask = static_cast<std::uint32_t>(table_.size() - 1);
    std::uint32_t slot = BlockHash(coord(id)) & mask;
    while (table_[slot] != 0) slot = (slot + 1) & mask;
    table_[slot] = id;
}

void BlockMap::GrowTable() {
    table_.assign(2 * table_.size(), 0);
    for (BlockId id = 1; id < size_; ++id)
        if (!IsFree(id)) InsertIntoTable(id);
}

// Registers the new block with every block that has it as a positive neighbour, and fills in its
// own eight neighbours.
void BlockMap::LinkNeighbours(BlockId id, const BlockCoord& c) {
    for (int slot = 0; slot < 8; ++slot) {
        const int dx = slot & 1, dy = slot >> 1 & 1, dz = slot >> 2;
        neighbours_[8 * static_cast<std::size_t>(id) + slot] = Find({c.x + dx, c.y + dy, c.z + dz});
        if (const BlockId before = Find({c.x - dx, c.y - dy, c.z - dz}); before != kUnknownBlock)
            neighbours_[8 * static_cast<std::size_t>(before) + slot] = id;
    }
}

void BlockMap::UnlinkNeighbours(BlockId id, const BlockCoord& c) {
    for (int slot = 0; slot < 8; ++slot) {
        const int dx = slot & 1, dy = slot >> 1 & 1, dz = slot >> 2;
        neighbours_[8 * static_cast<std::size_t>(id) + slot] = kUnknownBlock;
        if (const BlockId before = Find({c.x - dx, c.y - dy, c.z - dz}); before != kUnknownBlock)
            neighbours_[8 * static_cast<std::size_t>(before) + slot] = kUnknownBlock;
    }
}

BlockId BlockMap::neighbour(BlockId id, int dx, int dy, int dz) const {
    const BlockCoord c = coord(id);
    return Find({c.x + dx, c.y + dy, c.z + dz});
}

std::size_t BlockMap::bytes() const {
    const std::size_t per_voxel = sizeof(FieldWord) + (has_colours() ? sizeof(ColourWord) : 0) +
                                  (layers_ == Layers::kAll ? sizeof(std::uint16_t) : 0) +
                                  (labels_ ? sizeof(VoxelLabel) : 0);
    const std::size_t per_block =
        kBlockVoxels * per_voxel + (8 + 4 + 1) * sizeof(std::int32_t) + sizeof(BlockId);
    return static_cast<std::size_t>(count() + 1) * per_block +
           table_.size() * sizeof(std::int32_t) + regions_.bytes();
}

double BlockMap::bytes_per_voxel() const {
    return static_cast<double>(bytes()) / (static_cast<double>(count() + 1) * kBlockVoxels);
}

}  // namespace tessera
