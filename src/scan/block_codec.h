// One block's layers as a row of ScanTable::kBlocks: its number in the order of allocation, then the voxels, byte planes of
// each layer one after the other, zstd. Fused voxels are noisy: 5120 bytes become some 2900.
#pragma once

#include <optional>
#include <vector>

#include "mapping/block_map.h"
#include "scan/compression.h"

namespace tessera {

// Copies of blocks out of a map, for a thread that may not read it.
struct BlockCopies {
    std::vector<BlockId> ids;
    std::vector<BlockCoord> coords;
    std::vector<FieldWord> field;          // kBlockVoxels for each id
    std::vector<std::uint16_t> weight;     // likewise
    std::vector<ColourWord> colour;        // likewise
    std::vector<VoxelLabel> labels;        // likewise; empty without labels

    // Into storage that is used again. Nobody may write the map meanwhile.
    void Copy(const BlockMap& map, std::span<const BlockId> blocks);
};

// Owner thread only.
class BlockCodec {
  public:
    // The row's data, valid until the next call.
    const std::vector<std::uint8_t>& Encode(const BlockCopies& copies, std::size_t index);

    // The number of a row's block; nothing if the row is none, by its sizes.
    static std::optional<BlockId> IdOf(std::span<const std::uint8_t> row);
    // Into a block of a map; labels only where the map has them, none where the row has none. False: the row is none.
    bool Decode(std::span<const std::uint8_t> row, BlockMap& map, BlockId id);

  private:
    Compressor compressor_;
    std::vector<std::uint8_t> content_, row_;
};

}  // namespace tessera
