// The loop bodies of marching cubes (device_loops.h): one call per row of cells, voxel of an apron,
// or block. All arrays are indexed by the block's position in the list `ids`.
#pragma once

#include "cuda/device_surface.h"
#include "cuda/map_kernels.h"

namespace tessera::TESSERA_DEVICE {

// Rows per block: rows of eight cells, and rows of edges from a row's voxels along the three axes,
// in the order of BlockMesh's vertices.
inline constexpr int kCellRows = kBlockSide * kBlockSide, kEdgeRows = 3 * kCellRows;
inline constexpr int kBlocksAround = 27;

// Per block and block around it, x fastest: the other block's id, 0 if it is absent or not read.
struct FindReadBlocks {
    DeviceMapView map;
    const std::int32_t* ids;
    std::int32_t* reads;

    TESSERA_HD_MEMBER void operator()(int i) const {
        const int at = i % kBlocksAround, dx = at % 3 - 1, dy = at / 3 % 3 - 1, dz = at / 9 - 1;
        const BlockCoord c = CoordAt(map, ids[i / kBlocksAround]);
        reads[i] = ReadByMesh(dx, dy, dz) ? Find(map, {c.x + dx, c.y + dy, c.z + dz}) : 0;
    }
};

// Per block and row of CellRows.
struct ReadCellRows {
    DeviceMapView map;
    const std::int32_t* ids;
    CellLimits limits;
    RowBits* rows;

    TESSERA_HD_MEMBER void operator()(int i) const {
        const int row = i % CellRows::kRows, y = row % CellRows::kSide, z = row / CellRows::kSide;
        const std::int32_t* blocks =
            map.neighbours + 8 * static_cast<std::int64_t>(ids[i / CellRows::kRows]);
        RowBits bits{};
        for (int x = 0; x <= kBlockSide; ++x) {
            const VoxelPlace place = PlaceOf(x, y, z);
            const std::int64_t at =
                static_cast<std::int64_t>(blocks[place.slot]) * kBlockVoxels + place.offset;
            const std::uint32_t flags = CellFlags(map.field[at], map.weight[at], limits);
            bits.inside |= (flags & 1) << x;
            bits.usable |= (flags >> 1 & 1) << x;
            bits.band_end |= flags >> 2 << x;
        }
        rows[i] = bits;
    }
};

// Per block and row of cells.
struct CountSurface {
    const RowBits* rows;
    const CubeCase* cases;
    std::int32_t* vertices;   // kEdgeRows for each block
    std::int32_t* triangles;  // kCellRows for each block

    TESSERA_HD_MEMBER void operator()(int i) const {
        const int block = i / kCellRows, row = i % kCellRows, y = row % kBlockSide,
                  z = row / kBlockSide;
        const CellRows cells{rows + block * CellRows::kRows};
        for (int axis = 0; axis < 3; ++axis) {
            std::int32_t count = 0;
            for (std::uint32_t bits = cells.CrossedEdges(axis, y, z); bits != 0; bits &= bits - 1)
                ++count;
            vertices[block * kEdgeRows + axis * kCellRows + row] = count;
        }
        std::int32_t count = 0;
        const std::uint32_t surface = cells.SurfaceCells(y, z);
        for (int x = 0; x < kBlockSide; ++x)
            if (surface >> x & 1) count += cases[cells.Configuration(x, y, z)].triangle_count;
        triangles[i] = count;
    }
};

// Per block, plus once for the ends.
struct TakeFirsts {
    const std::int32_t* vertex_first;
    const std::int32_t* triangle_first;
    SurfaceArrays::First* first;

    TESSERA_HD_MEMBER void operator()(int block) const {
        first[block] = {vertex_first[block * kEdgeRows], triangle_first[block * kCellRows]};
    }
};

// Per block and word of its ApronField; only for blocks with vertices.
struct FillApron {
    DeviceMapView map;
    const std::int32_t* reads;
    const SurfaceArrays::First* first;
    FieldWord* aprons;

    TESSERA_HD_MEMBER void operator()(int i) const {
        const int block = i / ApronField::kWords, word = i % ApronField::kWords;
        if (first[block].vertex == first[block + 1].vertex) return;
        constexpr int kSide = ApronField::kSide;
        const int x = word % kSide - 1, y = word / kSide % kSide - 1,
                  z = word / (kSide * kSide) - 1;
        const int around = (x >> 3) + 1 + 3 * ((y >> 3) + 1 + 3 * ((z >> 3) + 1));
        const std::int64_t from =
            static_cast<std::int64_t>(reads[block * kBlocksAround + around]) * kBlockVoxels;
        aprons[i] = map.field[from + PlaceOf(x & 7, y & 7, z & 7).offset];
    }
};

// Per block and row of cells: writes what CountSurface counted.
struct EmitSurface {
    DeviceMapView map;
    const std::int32_t* ids;
    const RowBits* rows;
    const CubeCase* cases;
    const FieldWord* aprons;
    const std::int32_t* vertex_first;
    const std::int32_t* triangle_first;
    MeshVertex* vertices;
    std::array<MeshVertexRef, 3>* triangles;

    TESSERA_HD_MEMBER void operator()(int i) const {
        const int block = i / kCellRows, row = i % kCellRows, y = row % kBlockSide,
                  z = row / kBlockSide;
        const CellRows cells{rows + block * CellRows::kRows};
        for (int axis = 0; axis < 3; ++axis) {
            MeshVertex* out = vertices + vertex_first[block * kEdgeRows + axis * kCellRows + row];
            const std::uint32_t crossed = cells.CrossedEdges(axis, y, z);
            for (int x = 0; x < kBlockSide; ++x)
                if (crossed >> x & 1) *out++ = Vertex(block, axis, x, y, z);
        }
        std::array<MeshVertexRef, 3>* out = triangles + triangle_first[i];
        const std::uint32_t surface = cells.SurfaceCells(y, z);
        for (int x = 0; x < kBlockSide; ++x) {
            if (!(surface >> x & 1)) continue;
            const CubeCase& cell = cases[cells.Configuration(x, y, z)];
            for (int t = 0; t < cell.triangle_count; ++t, ++out)
                for (int k = 0; k < 3; ++k) (*out)[k] = VertexRefOf(cell.triangles[t][k], x, y, z);
        }
    }

    TESSERA_HD_MEMBER MeshVertex Vertex(int block, int axis, int x, int y, int z) const {
        const std::int32_t* blocks = map.neighbours + 8 * static_cast<std::int64_t>(ids[block]);
        const VoxelPlace here = PlaceOf(x, y, z),
                         next = PlaceOf(x + (axis == 0), y + (axis == 1), z + (axis == 2));
        const auto colour = [&](const VoxelPlace& at) {
            return map
                .colour[static_cast<std::int64_t>(blocks[at.slot]) * kBlockVoxels + at.offset];
        };
        return VertexOnEdge({aprons + block * ApronField::kWords}, axis, x, y, z, colour(here),
                            colour(next));
    }
};

}  // namespace tessera::TESSERA_DEVICE
