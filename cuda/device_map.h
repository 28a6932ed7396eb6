// The map on the device: BlockMap's pool, hash and neighbours (src/mapping/block_map.h), with the
// same ids and content. It does not support labels, released blocks, or numbers other than the ids.
#pragma once

#include <vector>

#include "cuda/device.h"
#include "mapping/allocation_kernels.h"
#include "mapping/block_map_view.h"
#include "mapping/visibility_kernels.h"

namespace tessera::TESSERA_DEVICE {

// Arrays that kernels write. Valid until the map grows.
struct DeviceMapView {
    FieldWord* field;
    std::uint16_t* weight;
    ColourWord* colour;
    std::int32_t* neighbours;
    std::int32_t* coords;
    std::uint32_t* revision;
    std::int32_t* table;
    std::uint32_t table_mask;
    float voxel_size_m;
    TruncationBand band;

    // What the kernels of src/ read.
    BlockMapView readable() const {
        return {field, neighbours, table, coords, table_mask, voxel_size_m, band};
    }
};

// Voxels in host memory: kBlockVoxels of each kind per id.
struct BlockVoxels {
    std::vector<std::int32_t> ids;
    std::vector<FieldWord> field;
    std::vector<std::uint16_t> weight;
    std::vector<ColourWord> colour;
};

// Owner thread only. `memory` and `stream` must outlive it.
class DeviceMap {
  public:
    DeviceMap(double voxel_size_m, const TruncationBand& band, DeviceMemory& memory,
              Stream& stream);

    // Returns false if the device has no room even for an empty map.
    [[nodiscard]] bool Clear();
    // Loads a map from which nothing was released: `size` blocks including the unknown one, with 4
    // coords each. Returns false if there is no room; the map is then empty.
    [[nodiscard]] bool Load(std::int32_t size, const std::int32_t* coords, const FieldWord* field,
                            const std::uint16_t* weight, const ColourWord* colour);

    struct Growth {
        std::vector<BlockCoord> added;  // with ids from the old size() on
        std::int64_t wanted = 0;        // missing blocks, added or not
        bool full = false;              // stopped by the memory limit
    };
    // Adds the blocks that the image needs and the map lacks, in the order of their coordinates, as
    // Integrator does. `walk.depth_m` is on the device.
    Growth Allocate(const BandWalk& walk, const WorldBox& box, int max_new_blocks);

    // Finds the ids of the blocks that the image may change, increasing, like VisibleBlocks.
    // Returns their number. The ids stay on the device and are valid until the next call. `tiles`
    // is on the device.
    int FindVisible(const DepthTileView& tiles, const ViewCone& cone);
    const std::int32_t* visible() const { return visible_.data(); }

    // Copies the blocks whose revision is `first` or later, in parts; calls take(voxels) for each.
    template <class Take>
    void DownloadSince(std::uint32_t first, BlockVoxels& voxels, const Take& take) {
        const int count = SelectSince(first);
        for (int begin = 0; begin < count; begin += kBlocksPerPart) {
            DownloadPart(begin, std::min(count - begin, kBlocksPerPart), voxels);
            take(voxels);
        }
    }

    DeviceMapView view();
    std::int32_t size() const { return size_; }  // including the unknown block
    double voxel_size_m() const { return voxel_size_m_; }

    static constexpr int kBlocksPerPart = 1024;

  private:
    struct Layers {
        explicit Layers(DeviceMemory& memory) : field(memory), weight(memory), colour(memory) {}
        // As DeviceBuffer::Reserve, in blocks.
        [[nodiscard]] bool Reserve(Stream& stream, std::size_t blocks, std::size_t keep);

        DeviceBuffer<FieldWord> field;
        DeviceBuffer<std::uint16_t> weight;
        DeviceBuffer<ColourWord> colour;
    };
    // Keys of the blocks that an image needs and the map lacks.
    struct WantedBlocks {
        explicit WantedBlocks(DeviceMemory& memory) : set(memory), keys(memory), sorted(memory) {}

        DeviceBuffer<std::uint64_t> set, keys, sorted;  // `set`: a hash table
    };

    [[nodiscard]] bool Reserve(std::int32_t blocks);
    [[nodiscard]] bool GrowTo(std::int32_t blocks);
    [[nodiscard]] bool GrowTable(std::int32_t blocks);
    bool MarkWanted(const BandWalk& walk, const WorldBox& box, int& wanted);
    void AddBlocks(int count);
    int SelectSince(std::uint32_t first);
    int Select(DeviceBuffer<std::int32_t>& ids);
    void DownloadPart(int begin, int count, BlockVoxels& voxels);

    double voxel_size_m_;
    TruncationBand band_;
    DeviceMemory& memory_;
    Stream& stream_;
    std::int32_t size_ = 0;
    bool full_ = false;  // growth failed; not tried again before Clear
    Layers layers_;
    DeviceBuffer<std::int32_t> neighbours_, coords_;
    DeviceBuffer<std::uint32_t> revision_;
    DeviceBuffer<std::int32_t> table_;
    std::size_t table_slots_ = 0;
    // Temporary buffers.
    DeviceSorter sorter_;
    WantedBlocks wanted_;
    DeviceBuffer<std::int32_t> count_;
    DeviceBuffer<std::uint8_t> keep_;
    DeviceBuffer<std::int32_t> visible_, selected_;
    Layers part_;  // of the blocks that are downloaded at once
};

}  // namespace tessera::TESSERA_DEVICE
