// Flag bits of a block's rows (cell_kernels.h), computed in a form that compilers vectorise. Used
// by block_mesh.cpp only.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "mapping/block_map.h"
#include "mapping/cell_kernels.h"

namespace tessera {

class CellBits {
  public:
    CellBits(const BlockMap& map, const std::array<BlockId, 8>& blocks, const CellLimits& limits) {
        // Indexed by voxel offset. Of each neighbour, only the part that borders this block is
        // filled.
        std::uint8_t own[kBlockVoxels], above[kBlockVoxels], behind[64], beyond[8];
        ReadFlags(map, blocks[0], 0, kBlockVoxels, limits, own);
        for (int z = 0; z < kBlockSide; ++z)
            ReadFlags(map, blocks[2], 64 * z, 8, limits, above + 64 * z);
        ReadFlags(map, blocks[4], 0, 64, limits, behind);
        ReadFlags(map, blocks[6], 0, 8, limits, beyond);
        for (int z = 0; z < CellRows::kSide; ++z)
            for (int y = 0; y < CellRows::kSide; ++y) {
                const auto [slot, offset] = PlaceOf(0, y, z);
                const std::uint8_t* parts[4] = {own, above, behind, beyond};
                std::uint8_t last;
                ReadFlags(map, blocks[slot | 1], offset, 1, limits, &last);
                const RowBits row = Row(parts[slot >> 1] + offset, last);
                any_inside_ |= row.usable & row.inside;
                any_outside_ |= row.usable & ~row.inside;
                rows_[CellRows::Index(y, z)] = row;
            }
    }

    // If false, the block has neither a crossed edge nor a surface cell.
    bool HasBothSigns() const { return any_inside_ != 0 && any_outside_ != 0; }

    CellRows view() const { return {rows_}; }

  private:
    // One byte per voxel.
    static void ReadFlags(const BlockMap& map, BlockId block, int offset, int count,
                          const CellLimits& limits, std::uint8_t* flags) {
        const FieldWord* field = map.field(block) + offset;
        const std::uint16_t* weight = map.weight(block) + offset;
        for (int i = 0; i < count; ++i) flags[i] = CellFlags(field[i], weight[i], limits);
    }
    // Bit i of the result is the lowest bit of byte i.
    static std::uint32_t LowestBits(std::uint64_t bytes) {
        return static_cast<std::uint32_t>((bytes & 0x0101010101010101u) * 0x0102040810204080u >>
                                          56);
    }
    // Packs eight voxels and the one after them.
    static RowBits Row(const std::uint8_t* flags, std::uint32_t last) {
        std::uint64_t bytes;
        std::memcpy(&bytes, flags, sizeof(bytes));
        if constexpr (std::endian::native == std::endian::big) bytes = __builtin_bswap64(bytes);
        return {LowestBits(bytes) | (last & 1) << 8, LowestBits(bytes >> 1) | (last >> 1 & 1) << 8,
                LowestBits(bytes >> 2) | last >> 2 << 8};
    }

    RowBits rows_[CellRows::kRows];
    std::uint32_t any_inside_ = 0, any_outside_ = 0;
};

}  // namespace tessera
