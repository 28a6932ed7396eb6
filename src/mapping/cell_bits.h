// Which cells and edges of a block hold surface: one bit per voxel of a row, so that a row of eight
// cells costs a few operations. Used by block_mesh.cpp only.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "mapping/block_map.h"

namespace tessera {

// A voxel is inside where its distance is negative, and usable where it has a distance and enough
// weight.
class CellBits {
  public:
    CellBits(const BlockMap& map, const std::array<BlockId, 8>& blocks, double min_weight) {
        const int steps = static_cast<int>(std::ceil(min_weight * kWeightSteps));
        // By voxel offset; of each block only the part that borders on this one.
        std::uint8_t own[kBlockVoxels], above[kBlockVoxels], behind[64], beyond[8];
        ReadFlags(map, blocks[0], 0, kBlockVoxels, steps, own);
        for (int z = 0; z < kBlockSide; ++z)
            ReadFlags(map, blocks[2], 64 * z, 8, steps, above + 64 * z);
        ReadFlags(map, blocks[4], 0, 64, steps, behind);
        ReadFlags(map, blocks[6], 0, 8, steps, beyond);
        for (int z = 0; z < kSide; ++z)
            for (int y = 0; y < kSide; ++y) {
                const int slot = y >> 3 << 1 | z >> 3 << 2, offset = (y & 7) * 8 + (z & 7) * 64;
                const std::uint8_t* parts[4] = {own, above, behind, beyond};
                std::uint8_t last;
                ReadFlags(map, blocks[slot | 1], offset, 1, steps, &last);
                const RowBits row = Row(parts[slot >> 1] + offset, last);
                any_inside_ |= row.usable & row.inside;
                any_outside_ |= row.usable & ~row.inside;
                rows_[z][y] = row;
            }
    }

    // If not, there is neither a crossed edge nor a surface cell.
    bool HasBothSigns() const { return any_inside_ != 0 && any_outside_ != 0; }

    // Bit x: the edge from voxel (x, y, z) along `axis` has one end inside, one outside.
    std::uint32_t CrossedEdges(int axis, int y, int z) const {
        const RowBits& a = rows_[z][y];
        if (axis == 0) return (a.inside ^ a.inside >> 1) & a.usable & a.usable >> 1 & kRowBits;
        const RowBits& b = axis == 1 ? rows_[z][y + 1] : rows_[z + 1][y];
        return (a.inside ^ b.inside) & a.usable & b.usable & kRowBits;
    }

    // Bit x: the cell at (x, y, z) is to be triangulated.
    std::uint32_t SurfaceCells(int y, int z) const {
        std::uint32_t usable = ~0u, all = ~0u, any = 0, far = 0, behind = 0;
        for (int corner = 0; corner < 4; ++corner) {
            const RowBits& r = rows_[z + (corner >> 1)][y + (corner & 1)];
            usable &= r.usable;
            all &= r.inside;
            any |= r.inside;
            far |= r.range_end & ~r.inside;
            behind |= r.range_end & r.inside;
        }
        const std::uint32_t jumps = (far | far >> 1) & (behind | behind >> 1);
        return usable & usable >> 1 & (any | any >> 1) & ~(all & all >> 1) & ~jumps & kRowBits;
    }

    int Configuration(int x, int y, int z) const {
        const auto pair = [&](int dy, int dz) { return rows_[z + dz][y + dy].inside >> x & 3; };
        return static_cast<int>(pair(0, 0) | pair(1, 0) << 2 | pair(0, 1) << 4 | pair(1, 1) << 6);
    }

  private:
    static constexpr int kSide = kBlockSide + 1;
    static constexpr std::uint32_t kRowBits = 0xff;  // of the block's own voxels
    // Distances from here on count as the end of the range; fused averages seldom reach it exactly.
    static constexpr int kRangeEnd = static_cast<int>(0.99f * kDistanceSteps);

    struct RowBits {
        std::uint32_t inside, usable, range_end;
    };

    // A byte per voxel with the three flags in bits 0 to 2. Written so that compilers vectorise it.
    static void ReadFlags(const BlockMap& map, BlockId block, int offset, int count,
                          int min_weight_steps, std::uint8_t* flags) {
        const FieldWord* field = map.field(block) + offset;
        const std::uint16_t* weight = map.weight(block) + offset;
        for (int i = 0; i < count; ++i) {
            const int distance = static_cast<std::int32_t>(field[i]) >> 16;
            const int usable = (distance != -32768) & (weight[i] >= min_weight_steps);
            const int range_end = (distance >= kRangeEnd) | (distance <= -kRangeEnd);
            flags[i] = static_cast<std::uint8_t>((distance < 0) | usable << 1 | range_end << 2);
        }
    }
    // Bit i: the lowest bit of byte i.
    static std::uint32_t LowestBits(std::uint64_t bytes) {
        return static_cast<std::uint32_t>((bytes & 0x0101010101010101u) * 0x0102040810204080u >>
                                          56);
    }
    // Of eight voxels and the one after them.
    static RowBits Row(const std::uint8_t* flags, std::uint32_t last) {
        std::uint64_t bytes;
        std::memcpy(&bytes, flags, sizeof(bytes));
        if constexpr (std::endian::native == std::endian::big) bytes = __builtin_bswap64(bytes);
        return {LowestBits(bytes) | (last & 1) << 8, LowestBits(bytes >> 1) | (last >> 1 & 1) << 8,
                LowestBits(bytes >> 2) | last >> 2 << 8};
    }

    RowBits rows_[kSide][kSide];
    std::uint32_t any_inside_ = 0, any_outside_ = 0;
};

}  // namespace tessera
