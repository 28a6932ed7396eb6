// Which cells and edges of a block hold surface: one bit per voxel of a row, so that a row of eight cells costs a few
// operations. Used by block_mesh.cpp only.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "mapping/block_map.h"

namespace tessera {

// A voxel is inside where its distance is negative, and usable where it has a distance and enough weight.
class CellBits {
  public:
    CellBits(const BlockMap& map, const std::array<BlockId, 8>& blocks, double min_weight) {
        const int steps = static_cast<int>(std::ceil(min_weight * kWeightSteps));
        for (int z = 0; z < kSide; ++z)
            for (int y = 0; y < kSide; ++y) {
                const int slot = y >> 3 << 1 | z >> 3 << 2;
                const int offset = (y & 7) * 8 + (z & 7) * 64;
                RowBits row;  // in registers
                const FieldWord* field = map.field(blocks[slot]) + offset;
                const std::uint16_t* weight = map.weight(blocks[slot]) + offset;
                for (int x = 0; x < kBlockSide; ++x) row.Add(x, field[x], weight[x], steps);
                const BlockId right = blocks[slot | 1];
                row.Add(kBlockSide, map.field(right)[offset], map.weight(right)[offset], steps);
                rows_[z][y] = row;
            }
    }

    // Bit x: the edge from voxel (x, y, z) along `axis` has one end inside, one outside.
    std::uint32_t CrossedEdges(int axis, int y, int z) const {
        const RowBits& a = rows_[z][y];
        if (axis == 0)
            return (a.inside ^ a.inside >> 1) & a.usable & a.usable >> 1 & kRowBits;
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
        std::uint32_t inside = 0, usable = 0, range_end = 0;

        void Add(int x, FieldWord word, std::uint16_t weight, int min_weight_steps) {
            const int distance = static_cast<std::int32_t>(word) >> 16;
            inside |= (word >> 31) << x;
            usable |= static_cast<std::uint32_t>(HasDistance(word) & (weight >= min_weight_steps)) << x;
            range_end |= static_cast<std::uint32_t>(std::abs(distance) >= kRangeEnd) << x;
        }
    };
    RowBits rows_[kSide][kSide];
};

}  // namespace tessera
