// The vertices of marching cubes, one edge at a time, and the references by which triangles name
// them. Host-device, shared by the CPU code and CUDA.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "core/image.h"
#include "mapping/cell_kernels.h"
#include "mapping/marching_cubes_tables.h"

namespace tessera {

// A block's field with an apron of one voxel below and two above along each axis, x fastest.
// `words` points to a copy or to shared memory.
struct ApronField {
    static constexpr int kSide = kBlockSide + 3;
    static constexpr int kWords = kSide * kSide * kSide;
    const FieldWord* words;

    // x, y, z in [-1, kBlockSide + 2).
    TESSERA_HD_MEMBER static int Index(int x, int y, int z) {
        return x + 1 + kSide * (y + 1 + kSide * (z + 1));
    }
    TESSERA_HD_MEMBER static int Stride(int axis) {
        return axis == 0 ? 1 : axis == 1 ? kSide : kSide * kSide;
    }

    // Slope of the distance along an axis, in truncations per voxel: the central difference,
    // one-sided or zero where neighbours are unknown.
    TESSERA_HD_MEMBER float Slope(int index, int axis) const {
        const FieldWord here = words[index];
        FieldWord before = words[index - Stride(axis)], after = words[index + Stride(axis)];
        const bool both = HasDistance(before) && HasDistance(after);
        if (!HasDistance(before)) before = here;
        if (!HasDistance(after)) after = here;
        return (FieldDistance(after) - FieldDistance(before)) * (both ? 0.5f : 1.0f);
    }
};

// Whether a block's mesh reads voxels of the block at this offset, each in {-1, 0, 1}. It reads the
// block itself, the positive neighbours (cell corners), and the blocks one step further along an
// axis (gradients at the ends of edges).
TESSERA_HD constexpr bool ReadByMesh(int dx, int dy, int dz) {
    const int below = (dx < 0) + (dy < 0) + (dz < 0), above = (dx > 0) + (dy > 0) + (dz > 0);
    return below == 0 || (below == 1 && above <= 1);
}

// Edge axis * 512 + o of a block runs from its voxel o to the next voxel along `axis`.
struct MeshVertex {
    std::uint16_t edge;
    std::uint16_t fraction;              // position along the edge, in 1/65536; never 0
    std::array<std::int16_t, 2> normal;  // octahedral
    Rgb8 colour;
    std::uint8_t has_colour;  // 0 or 1; if 0, colour is mid grey
};

// A triangle's corner: neighbour slot (as in BlockMapView) << kMeshSlotShift | edge in that block.
using MeshVertexRef = std::uint16_t;
inline constexpr int kMeshSlotShift = 11;

// Refers to the vertex on a cube's edge, for the block's cell at (x, y, z).
TESSERA_HD MeshVertexRef VertexRefOf(int cube_edge, int x, int y, int z) {
    const CubeEdge e = CubeEdgeAt(cube_edge);
    const VoxelPlace at = PlaceOf(x + (e.corner & 1), y + (e.corner >> 1 & 1), z + (e.corner >> 2));
    return static_cast<MeshVertexRef>(at.slot << kMeshSlotShift |
                                      (e.axis * kBlockVoxels + at.offset));
}

// Octahedral encoding of a vector of any non-zero length. VertexNormal decodes it.
TESSERA_HD void EncodeNormal(const float* n, std::int16_t* code) {
    const float length = abs(n[0]) + (abs(n[1]) + abs(n[2]));
    const float x = n[0] / length, y = n[1] / length;
    const bool behind = n[2] / length < 0;
    const float uv[2] = {behind ? std::copysign(1 - abs(y), x) : x,
                         behind ? std::copysign(1 - abs(x), y) : y};
    for (int k = 0; k < 2; ++k)
        code[k] = static_cast<std::int16_t>(uv[k] * 32767 + std::copysign(0.5f, uv[k]));
}

TESSERA_HD std::uint8_t ColourByte(float value) {
    return static_cast<std::uint8_t>(value * 255.0f + 0.5f);
}

// [D18] eq. 10: interpolates from voxel 1 to voxel 2 by the fraction m. If only one voxel has a
// colour, returns that colour; if neither has one, grey.
TESSERA_HD Rgb8 MixColours(FieldWord w1, ColourWord c1, FieldWord w2, ColourWord c2, float m) {
    if (!HasIntensity(w1) && !HasIntensity(w2)) return {128, 128, 128};
    const LinearRgb a = HasIntensity(w1) ? ColourFromWords(w1, c1) : ColourFromWords(w2, c2);
    const LinearRgb b = HasIntensity(w2) ? ColourFromWords(w2, c2) : a;
    return {ColourByte(a.r + m * (b.r - a.r)), ColourByte(a.g + m * (b.g - a.g)),
            ColourByte(a.b + m * (b.b - a.b))};
}

// The vertex on the edge from the block's voxel (x, y, z) along `axis`. The ends of the edge lie on
// opposite sides of the surface; c1 and c2 are their colours.
TESSERA_HD MeshVertex VertexOnEdge(const ApronField& field, int axis, int x, int y, int z,
                                   ColourWord c1, ColourWord c2) {
    const int i1 = ApronField::Index(x, y, z), i2 = i1 + ApronField::Stride(axis);
    const FieldWord w1 = field.words[i1], w2 = field.words[i2];
    const float d1 = FieldDistance(w1), d2 = FieldDistance(w2);
    // [D18] eq. 9, kept off the ends: a voxel at exactly zero would give degenerate triangles.
    constexpr float kMargin = 1e-3f;
    const float m = min(max(d1 / (d1 - d2), kMargin), 1 - kMargin);
    float n[3];
    for (int k = 0; k < 3; ++k) n[k] = (1 - m) * field.Slope(i1, k) + m * field.Slope(i2, k);
    if (n[0] * n[0] + (n[1] * n[1] + n[2] * n[2]) < 1e-12f)
        for (int k = 0; k < 3; ++k) n[k] = k != axis ? 0.0f : d2 > d1 ? 1.0f : -1.0f;
    MeshVertex v;
    v.edge = static_cast<std::uint16_t>(axis * kBlockVoxels + PlaceOf(x, y, z).offset);
    v.fraction = static_cast<std::uint16_t>(m * 65536 + 0.5f);
    EncodeNormal(n, v.normal.data());
    v.colour = MixColours(w1, c1, w2, c2, m);
    v.has_colour = HasIntensity(w1) || HasIntensity(w2);
    return v;
}

}  // namespace tessera
