// Finds the cells and edges of a block that contain surface. Each row stores one bit per voxel, so
// that eight cells cost a few operations. Host-device, shared by the CPU code and CUDA.
#pragma once

#include <cstdint>

#include "mapping/voxel.h"

namespace tessera {

// Location of a block's voxel (x, y, z), each in [0, 2 kBlockSide): the neighbour slot (as in
// BlockMapView) and the offset inside that neighbour.
struct VoxelPlace {
    std::int32_t slot, offset;
};
TESSERA_HD VoxelPlace PlaceOf(int x, int y, int z) {
    return {x >> 3 | y >> 3 << 1 | z >> 3 << 2, (x & 7) + 8 * (y & 7) + 64 * (z & 7)};
}

// What CellFlags asks of a voxel.
struct CellLimits {
    int weight;    // least weight, in units of 1/kWeightSteps
    int band_end;  // distances from here on, in steps, are beyond the narrowest band
};

// A voxel's flags. Bit 0 (inside): its distance is negative. Bit 1 (usable): it has a distance and
// enough weight. Bit 2 (band end): its distance is beyond the narrowest band.
TESSERA_HD std::uint8_t CellFlags(FieldWord field, std::uint16_t weight, const CellLimits& limits) {
    const int distance = static_cast<std::int32_t>(field) >> 16;
    const int usable = (distance != -32768) & (weight >= limits.weight);
    const int band_end = (distance >= limits.band_end) | (distance <= -limits.band_end);
    return static_cast<std::uint8_t>((distance < 0) | usable << 1 | band_end << 2);
}

// Flags of a row's eight voxels and the one after them; bit x is voxel x.
struct RowBits {
    std::uint32_t inside, usable, band_end;
};

// A block's rows along x, plus the adjacent rows above it along y and z.
struct CellRows {
    static constexpr int kSide = kBlockSide + 1;
    static constexpr int kRows = kSide * kSide;
    static constexpr std::uint32_t kRowBits = 0xff;  // the block's own voxels
    const RowBits* rows;

    // y, z in [0, kSide).
    TESSERA_HD_MEMBER static int Index(int y, int z) { return y + kSide * z; }

    // Bit x: the edge from voxel (x, y, z) along `axis` has one end inside and one outside.
    TESSERA_HD_MEMBER std::uint32_t CrossedEdges(int axis, int y, int z) const {
        const RowBits& a = rows[Index(y, z)];
        if (axis == 0) return (a.inside ^ a.inside >> 1) & a.usable & a.usable >> 1 & kRowBits;
        const RowBits& b = axis == 1 ? rows[Index(y + 1, z)] : rows[Index(y, z + 1)];
        return (a.inside ^ b.inside) & a.usable & b.usable & kRowBits;
    }

    // Bit x: the cell at (x, y, z) must be triangulated.
    TESSERA_HD_MEMBER std::uint32_t SurfaceCells(int y, int z) const {
        std::uint32_t usable = ~0u, all = ~0u, any = 0, far = 0, behind = 0;
        for (int corner = 0; corner < 4; ++corner) {
            const RowBits& r = rows[Index(y + (corner & 1), z + (corner >> 1))];
            usable &= r.usable;
            all &= r.inside;
            any |= r.inside;
            far |= r.band_end & ~r.inside;
            behind |= r.band_end & r.inside;
        }
        const std::uint32_t jumps = (far | far >> 1) & (behind | behind >> 1);
        return usable & usable >> 1 & (any | any >> 1) & ~(all & all >> 1) & ~jumps & kRowBits;
    }

    // Index into CubeCases.
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
