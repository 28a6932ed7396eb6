// Which cells and edges of a block hold surface: one bit per voxel of a row, so that a row of eight
// cells costs a few operations. Host-device, shared by the CPU and CUDA.
#pragma once

#include <cstdint>

#include "mapping/voxel.h"

namespace tessera {

// Where a block's voxel (x, y, z) is, each in [0, 2 kBlockSide): in the neighbour at this slot of
// BlockMapView, at this offset.
struct VoxelPlace {
    std::int32_t slot, offset;
};
TESSERA_HD VoxelPlace PlaceOf(int x, int y, int z) {
    return {x >> 3 | y >> 3 << 1 | z >> 3 << 2, (x & 7) + 8 * (y & 7) + 64 * (z & 7)};
}

// A voxel's flags in bits 0 to 2: inside where its distance is negative; usable where it has a
// distance and enough weight, which counts in 1/kWeightSteps; and at an end of the distance's
// range.
TESSERA_HD std::uint8_t CellFlags(FieldWord field, std::uint16_t weight, int min_weight_steps) {
    // Distances from here on count as the end of the range; fused averages seldom reach it exactly.
    constexpr int kRangeEnd = static_cast<int>(0.99f * kDistanceSteps);
    const int distance = static_cast<std::int32_t>(field) >> 16;
    const int usable = (distance != -32768) & (weight >= min_weight_steps);
    const int range_end = (distance >= kRangeEnd) | (distance <= -kRangeEnd);
    return static_cast<std::uint8_t>((distance < 0) | usable << 1 | range_end << 2);
}

// The flags of a row's eight voxels and the one after them: bit x is voxel x.
struct RowBits {
    std::uint32_t inside, usable, range_end;
};

// A block's rows along x, with those just above it along y and z.
struct CellRows {
    static constexpr int kSide = kBlockSide + 1;
    static constexpr int kRows = kSide * kSide;
    static constexpr std::uint32_t kRowBits = 0xff;  // of the block's own voxels
    const RowBits* rows;

    // y, z in [0, kSide).
    TESSERA_HD_MEMBER static int Index(int y, int z) { return y + kSide * z; }

    // Bit x: the edge from voxel (x, y, z) along `axis` has one end inside, one outside.
    TESSERA_HD_MEMBER std::uint32_t CrossedEdges(int axis, int y, int z) const {
        const RowBits& a = rows[Index(y, z)];
        if (axis == 0) return (a.inside ^ a.inside >> 1) & a.usable & a.usable >> 1 & kRowBits;
        const RowBits& b = axis == 1 ? rows[Index(y + 1, z)] : rows[Index(y, z + 1)];
        return (a.inside ^ b.inside) & a.usable & b.usable & kRowBits;
    }

    // Bit x: the cell at (x, y, z) is to be triangulated.
    TESSERA_HD_MEMBER std::uint32_t SurfaceCells(int y, int z) const {
        std::uint32_t usable = ~0u, all = ~0u, any = 0, far = 0, behind = 0;
        for (int corner = 0; corner < 4; ++corner) {
            const RowBits& r = rows[Index(y + (corner & 1), z + (corner >> 1))];
            usable &= r.usable;
            all &= r.inside;
            any |= r.inside;
            far |= r.range_end & ~r.inside;
            behind |= r.range_end & r.inside;
        }
        const std::uint32_t jumps = (far | far >> 1) & (behind | behind >> 1);
        return usable & usable >> 1 & (any | any >> 1) & ~(all & all >> 1) & ~jumps & kRowBits;
    }

    // As CubeCases counts them.
    TESSERA_HD_MEMBER int Configuration(int x, int y, int z) const {
        int configuration = 0;
        for (int corner = 0; corner < 4; ++corner) {
            const RowBits& r = rows[Index(y + (corner & 1), z + (corner >> 1))];
            configuration |= static_cast<int>(r.inside >> x & 3) << 2 * corner;
        }
        return configuration;
    }
};

}  // namespace tessera
