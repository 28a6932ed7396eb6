// One block's layers as a row of ScanTable::kBlocks: its number in allocation order, then the
// voxels, compressed with zstd. The layers follow each other, each split into byte planes. Fused
// voxels are noisy: 5120 bytes shrink to about 2900.
#pragma once

#include <optional>
#include <vector>

#include "mapping/block_map.h"
#include "scan/compression.h"
#include "scan/scan_row.h"

namespace tessera {

// Copies of a map's blocks, for threads that may not read the map.
struct BlockCopies {
    std::vector<std::int32_t> numbers;  // BlockMap::number
    std::vector<BlockCoord> coords;
    std::vector<FieldWord> field;       // kBlockVoxels per block
    std::vector<std::uint16_t> weight;  // same
    std::vector<ColourWord> colour;     // same
    std::vector<VoxelLabel> labels;     // same; empty without labels

    // Copies into recycled storage. Nobody may write to the map meanwhile.
    void Copy(const BlockMap& map, std::span<const BlockId> blocks);
    // Appends a block; the caller fills in its voxels. If any block has labels, all have room for
    // them.
    void Append(const BlockCoord& coord, std::int32_t number, bool labels);
    // Copies block `index` (from 0) into a block of a map; labels only if both have them.
    void Put(std::size_t index, BlockMap& map, BlockId id) const;
    // The blocks' keys with their indices, by increasing key.
    std::vector<std::pair<std::int64_t, std::size_t>> ByKey() const;
    void Clear();
    std::size_t size() const { return numbers.size(); }
};

// Owner thread only.
class BlockCodec {
  public:
    // Returns the row's data, valid until the next call.
    const std::vector<std::uint8_t>& Encode(const BlockCopies& copies, std::size_t index);

    // Returns the number of the row's block; nullopt if the row's sizes are invalid.
    static std::optional<std::int32_t> NumberOf(std::span<const std::uint8_t> data);
    // Appends a row's block to `copies`, with labels if the row has them. If the row is invalid,
    // returns false and appends nothing.
    bool Decode(std::int64_t key, std::span<const std::uint8_t> data, BlockCopies& copies);

  private:
    Compressor compressor_;
    std::vector<std::uint8_t> content_, data_;
};

}  // namespace tessera
