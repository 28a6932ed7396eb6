// The map: a pool of voxel blocks near the surface, indexed by a hash of the block coordinate, with
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
// voxels. Absent blocks resolve to block 0, so readers need no branch.
using BlockId = std::int32_t;
inline constexpr BlockId kUnknownBlock = 0;

class BlockMap {
  public:
    static constexpr double kWidestBand = 4;  // truncations
    struct Config {
        double voxel_size_m = 0.01;
        double truncation_m = 0.04;  // half width of the band near the camera
        double band_per_m = 0;       // TruncationBand::per_m; the band is the same everywhere if 0

        TruncationBand band() const;
        // The largest distance that is stored: the widest band.
        double range_m() const {
            return band_per_m > 0 ? kWidestBand * truncation_m : truncation_m;
        }

        void Describe(ConfigParameters& parameters);
        // Checks conditions between keys. The range of each key is checked when the key is set.
        Status Validate() const;
    };

    // Which layers a map stores. A reader's copy needs only the field, and colours if it aligns
    // chroma. Weights that are not stored read as zero, colours as grey.
    enum class Layers { kAll, kFieldAndColour, kFieldOnly };

    explicit BlockMap(const Config& config, Layers layers = Layers::kAll);

    const Config& config() const { return config_; }
    // Valid until the next Allocate, Release or Clear.
    BlockMapView view() const;

    // Ids run from 0 to size() - 1 and include the free ids of released blocks. Without Release,
    // ids follow the order of allocation.
    BlockId size() const { return size_; }
    std::size_t max_size() const { return max_size_; }
    bool IsFree(BlockId id) const { return neighbours_[8 * static_cast<std::size_t>(id)] != id; }
    // Number of allocated blocks, excluding block 0.
    std::int64_t count() const { return size_ - 1 - static_cast<std::int64_t>(free_.size()); }

    BlockId Find(const BlockCoord& coord) const;
    // Returns the block and allocates it if absent, under the lowest free id. Returns kUnknownBlock
    // if the map is full or the coordinate is out of limits.
    BlockId Allocate(const BlockCoord& coord) { return Allocate(coord, next_number_); }
    // Reallocates a released block under its previous number.
    BlockId Allocate(const BlockCoord& coord, std::int32_t number);
    // Allocates a new block under an id that is not smaller than size(). Skipped ids become free.
    // For maps that use the same ids as another map.
    void AllocateAs(BlockId id, const BlockCoord& coord);
    // Removes the block and frees its id. Not for block 0.
    void Release(BlockId id);
    void Clear();

    BlockCoord coord(BlockId id) const;
    // Counts blocks from 1 in the order of their first allocation. Unlike the id, the number does
    // not depend on releases. Without Release it equals the id.
    std::int32_t number(BlockId id) const { return coords_[4 * static_cast<std::size_t>(id) + 3]; }
    // Blocks allocated from now on get numbers from this one up. Lower numbers belong to released
    // blocks.
    void SetNextNumber(std::int32_t number) { next_number_ = number; }
    std::int32_t next_number() const { return next_number_; }
    // Numbers the blocks anew in the order of their ids, without gaps. For a map of which no
    // released block comes back.
    void NumberAnew();
    // dx, dy, dz in {-1, 0, 1}. Does a hash look-up.
    BlockId neighbour(BlockId id, int dx, int dy, int dz) const;

    // The voxels of one block, kBlockVoxels per layer.
    FieldWord* field(BlockId id) { return field_.data() + Offset(id); }
    const FieldWord* field(BlockId id) const { return field_.data() + Offset(id); }
    std::uint16_t* weight(BlockId id) { return weight_.data() + Offset(id); }
    const std::uint16_t* weight(BlockId id) const { return weight_.data() + Offset(id); }
    ColourWord* colour(BlockId id) { return colour_.data() + Offset(id); }
    const ColourWord* colour(BlockId id) const {
        return colour_.data() + (has_colours() ? Offset(id) : 0);
    }
    Layers layers() const { return layers_; }
    bool has_colours() const { return layers_ != Layers::kFieldOnly; }
    // All blocks' colours, indexed like view().field; null if they are not stored.
    const ColourWord* colours() const { return has_colours() ? colour_.data() : nullptr; }

    // Adds the label layer, which takes memory only where it is written. Call at most once. The
    // blocks so far have no labels.
    void EnableLabels();
    bool has_labels() const { return labels_.has_value(); }
    // Only if has_labels().
    VoxelLabel* label(BlockId id) { return labels_->data() + Offset(id); }
    const VoxelLabel* label(BlockId id) const { return labels_->data() + Offset(id); }

    // Change tracking: the writer marks changed blocks with its own increasing revision number.
    void MarkChanged(BlockId id, std::uint32_t revision) {
        revision_[static_cast<std::size_t>(id)] = revision;
    }
    std::uint32_t revision(BlockId id) const { return revision_[static_cast<std::size_t>(id)]; }

    // The blocks of a region (RegionOf). They make the cost of a frame depend on the view, not on
    // the size of the map. The span is valid until the next Allocate, Release or Clear.
    std::span<const BlockId> BlocksInRegion(const BlockCoord& region) const {
        return regions_.Blocks(region);
    }

    std::size_t bytes() const;  // memory in use by blocks and their index
    double bytes_per_voxel() const;

    // Unique among the maps of this process; Clear assigns a new one. Holders of copied map content
    // use it to detect that the copy belongs to another map.
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
    std::vector<BlockId> free_;  // min-heap
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
