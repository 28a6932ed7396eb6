// One block's layers as a row of ScanTable::kBlocks: its number in the order of allocation, then
// the voxels, byte planes of each layer one after the other, zstd. Fused voxels are noisy: 5120
// bytes become some 2900.
#pragma once

#include <optional>
#include <vector>

#include "mapping/block_map.h"
#include "scan/compression.h"

namespace tessera {

// Copies of blocks out of a map, for a thread that may not read it.
struct BlockCopies {
    std::vector<std::int32_t> numbers;  // BlockMap::number
    std::vector<BlockCoord> coords;
    std::vector<FieldWord> field;       // kBlockVoxels for each block
    std::vector<std::uint16_t> weight;  // likewise
    std::vector<ColourWord> colour;     // likewise
    std::vector<VoxelLabel> labels;     // likewise; empty without labels

    // Into storage that is used again. Nobody may write the map meanwhile.
    void Copy(const BlockMap& map, std::span<const BlockId> blocks);
    // Room for one more, uninitialised; `labels`: for all blocks or none.
    void Append(const BlockCoord& coord, std::int32_t number, bool labels);
    // Into a block of a map, `index` counting from 0.
    void Put(std::size_t index, BlockMap& map, BlockId id) const;
    void Clear();
    std::size_t size() const { return numbers.size(); }
};

// Owner thread only.
class BlockCodec {
  public:
    // The row's data, valid until the next call.
    const std::vector<std::uint8_t>& Encode(const BlockCopies& copies, std::size_t index);

    // The number of a row's block; nothing if the row is none, by its sizes.
    static std::optional<std::int32_t> NumberOf(std::span<const std::uint8_t> row);
    // Into a block of a map; labels only where the map has them, none where the row has none.
    // False: the row is none.
    bool Decode(std::span<const std::uint8_t> row, BlockMap& map, BlockId id);
    // Appended to copies, with labels if the row has them. False: the row is none, and nothing was
    // appended.
    bool Decode(std::span<const std::uint8_t> row, const BlockCoord& coord, BlockCopies& copies);

  private:
    bool Unpack(std::span<const std::uint8_t> row);

    Compressor compressor_;
    std::vector<std::uint8_t> content_, row_;
};

}  // namespace tessera
