// The map: a pool of voxel blocks near the surface, found through a hash of the block coordinate,
// one array per attribute (layer). One writer; any number of readers while nobody writes.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/config.h"
#include "core/status.h"
#include "mapping/block_map_view.h"
#include "mapping/block_regions.h"
#include "mapping/virtual_array.h"
#include "mapping/voxel.h"
#include "mapping/voxel_label.h"

namespace tessera {

// Index of a block in the pool. Block 0 always exists, is never written and holds only unknown
// voxels: what is not in the map is block 0, so that readers need no branch.
using BlockId = std::int32_t;
inline constexpr BlockId kUnknownBlock = 0;

class BlockMap {
  public:
    struct Config {
        double voxel_size_m = 0.01;
        double truncation_m = 0.04;  // the band's half width; distances are clamped to it

        void Describe(ConfigParameters& parameters);
        // Conditions between keys; single ranges are checked when a key is set.
        Status Validate() const;
    };

    // What a map keeps: a copy for a reader needs the field only; its weights are then zero and its
    // colours grey.
    enum class Layers { kAll, kFieldOnly };

    explicit BlockMap(const Config& config, Layers layers = Layers::kAll);

    const Config& config() const { return config_; }
    // Valid until the next Allocate, Release or Clear.
    BlockMapView view() const;

    // Ids run from 0 to size() - 1; those between that were released are free. Without Release: in
    // order of allocation.
    BlockId size() const { return size_; }
    std::size_t max_size() const { return max_size_; }
    bool IsFree(BlockId id) const { return neighbours_[8 * static_cast<std::size_t>(id)] != id; }
    // Blocks that are there, block 0 not counted.
    std::int64_t count() const { return size_ - 1 - static_cast<std::int64_t>(free_.size()); }

    BlockId Find(const BlockCoord& coord) const;
    // The block, made if it is not there; kUnknownBlock if the map is full or the coordinate out of
    // limits. Of the ids that are free the lowest is taken.
    BlockId Allocate(const BlockCoord& coord) { return Allocate(coord, next_number_); }
    // A block that was released comes back under the number that it had.
    BlockId Allocate(const BlockCoord& coord, std::int32_t number);
    // A new block under an id that is not smaller than size(); the ids skipped are free. For a map
    // with the same ids as another.
    void AllocateAs(BlockId id, const BlockCoord& coord);
    // The block goes: unknown to all, its id free. Not block 0.
    void Release(BlockId id);
    void Clear();

    BlockCoord coord(BlockId id) const;
    // Counts blocks from 1 on in the order of their first allocation: unlike the id the same
    // whatever was released meanwhile. Without Release it is the id.
    std::int32_t number(BlockId id) const { return coords_[4 * static_cast<std::size_t>(id) + 3]; }
    // Blocks allocated from here on carry numbers from this one on: those below are known to be
    // released ones'.
    void SetNextNumber(std::int32_t number) { next_number_ = number; }
    std::int32_t next_number() const { return next_number_; }
    // Each in {-1, 0, 1}; a hash look-up.
    BlockId neighbour(BlockId id, int dx, int dy, int dz) const;

    // One block's voxels, kBlockVoxels of each.
    FieldWord* field(BlockId id) { return field_.data() + Offset(id); }
    const FieldWord* field(BlockId id) const { return field_.data() + Offset(id); }
    std::uint16_t* weight(BlockId id) { return weight_.data() + Offset(id); }
    const std::uint16_t* weight(BlockId id) const { return weight_.data() + Offset(id); }
    ColourWord* colour(BlockId id) { return colour_.data() + Offset(id); }
    const ColourWord* colour(BlockId id) const {
        return colour_.data() + (layers_ == Layers::kAll ? Offset(id) : 0);
    }

    // The layer of labels exists from here on, and costs memory where it is written. To be called
    // while the map is empty.
    void EnableLabels();
    bool has_labels() const { return labels_.has_value(); }
    // Only with has_labels.
    VoxelLabel* label(BlockId id) { return labels_->data() + Offset(id); }
    const VoxelLabel* label(BlockId id) const { return labels_->data() + Offset(id); }

    // Change tracking: the writer marks what it changed with its own increasing number.
    void MarkChanged(BlockId id, std::uint32_t revision) {
        revision_[static_cast<std::size_t>(id)] = revision;
    }
    std::uint32_t revision(BlockId id) const { return revision_[static_cast<std::size_t>(id)]; }

    // The blocks of a region (RegionOf), so that the cost of a frame follows what is in view, not
    // the size of the map. The span is valid until the next Allocate, Release or Clear.
    std::span<const BlockId> BlocksInRegion(const BlockCoord& region) const {
        return regions_.Blocks(region);
    }

    std::size_t bytes() const;  // memory in use by blocks and their index
    double bytes_per_voxel() const;

    // A number that no other map of this process has, and a new one after Clear: whoever keeps
    // copies of the map's content tells by it that they are another map's.
    std::uint64_t identity() const { return identity_; }

  private:
    static std::size_t Offset(BlockId id) { return static_cast<std::size_t>(id) * kBlockVoxels; }
    void InitialiseBlock(BlockId id, const BlockCoord& coord, std::int32_t number);
    void Enter(BlockId id, const BlockCoord& coord, std::int32_t number);
    void InsertIntoTable(BlockId id);
    void GrowTable();
    void LinkNeighbours(BlockId id, const BlockCoord& coord);
    void UnlinkNeighbours(BlockId id, const BlockCoord& coord);
    BlockId TakeId();

    Config config_;
    Layers layers_;
    BlockId size_ = 1;
    std::int32_t next_number_ = 1;
    std::vector<BlockId> free_;  // a heap, the lowest first
    std::size_t max_size_ = 0;
    std::uint64_t identity_ = 0;
    VirtualArray<FieldWord> field_;
    VirtualArray<std::uint16_t> weight_;
    VirtualArray<ColourWord> colour_;
    std::optional<VirtualArray<VoxelLabel>> labels_;
    VirtualArray<std::int32_t> neighbours_;
    VirtualArray<std::int32_t> coords_;
    VirtualArray<std::uint32_t> revision_;
    std::vector<std::int32_t> table_;
    BlockRegions regions_;
};

}  // namespace tessera
