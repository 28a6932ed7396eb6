// The vertices of marching cubes, one edge at a time. Host-device, shared by the CPU and CUDA.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/image.h"
#include "mapping/voxel.h"

namespace tessera {

// A block's field with an apron of one voxel below and two above along each axis, x fastest: a copy, or shared memory.
struct ApronField {
    static constexpr int kSide = kBlockSide + 3;
    static constexpr int kWords = kSide * kSide * kSide;
    const FieldWord* words;

    // x, y, z in [-1, kBlockSide + 2).
    TESSERA_HD_MEMBER static int Index(int x, int y, int z) { return x + 1 + kSide * (y + 1 + kSide * (z + 1)); }
    TESSERA_HD_MEMBER static int Stride(int axis) { return axis == 0 ? 1 : axis == 1 ? kSide : kSide * kSide; }

    // Of the distance along an axis, in truncations per voxel: the central difference, one-sided or zero where
    // neighbours are unknown.
    TESSERA_HD_MEMBER float Slope(int index, int axis) const {
        const FieldWord here = words[index];
        FieldWord before = words[index - Stride(axis)], after = words[index + Stride(axis)];
        const bool both = HasDistance(before) && HasDistance(after);
        if (!HasDistance(before)) before = here;
        if (!HasDistance(after)) after = here;
        return (FieldDistance(after) - FieldDistance(before)) * (both ? 0.5f : 1.0f);
    }
};

// What BlockMesh::Vertex says of a vertex besides its edge.
struct EdgeVertex {
    std::uint16_t fraction;
    std::int16_t normal[2];
    Rgb8 colour;
    std::uint8_t has_colour;
};

// Octahedral, from a vector of any length but 0; VertexNormal undoes it.
TESSERA_HD void EncodeNormal(const float* n, std::int16_t* code) {
    const float length = abs(n[0]) + (abs(n[1]) + abs(n[2]));
    const float x = n[0] / length, y = n[1] / length;
    const bool behind = n[2] / length < 0;
    const float uv[2] = {behind ? std::copysign(1 - abs(y), x) : x, behind ? std::copysign(1 - abs(x), y) : y};
    for (int k = 0; k < 2; ++k) code[k] = static_cast<std::int16_t>(uv[k] * 32767 + std::copysign(0.5f, uv[k]));
}

TESSERA_HD std::uint8_t ColourByte(float value) { return static_cast<std::uint8_t>(value * 255.0f + 0.5f); }

// [D18] eq. 10, m of the way from one voxel to the other; where one has no colour, the other's; where none has, grey.
TESSERA_HD Rgb8 MixColours(FieldWord w1, ColourWord c1, FieldWord w2, ColourWord c2, float m) {
    if (!HasIntensity(w1) && !HasIntensity(w2)) return {128, 128, 128};
    const LinearRgb a = HasIntensity(w1) ? ColourFromWords(w1, c1) : ColourFromWords(w2, c2);
    const LinearRgb b = HasIntensity(w2) ? ColourFromWords(w2, c2) : a;
    return {ColourByte(a.r + m * (b.r - a.r)), ColourByte(a.g + m * (b.g - a.g)), ColourByte(a.b + m * (b.b - a.b))};
}

// The vertex on the edge from the block's voxel (x, y, z) along `axis`, whose ends lie on both sides of the surface;
// c1 and c2 are their colours.
TESSERA_HD EdgeVertex VertexOnEdge(const ApronField& field, int axis, int x, int y, int z, ColourWord c1,
                                   ColourWord c2) {
    const int i1 = ApronField::Index(x, y, z), i2 = i1 + ApronField::Stride(axis);
    const FieldWord w1 = field.words[i1], w2 = field.words[i2];
    const float d1 = FieldDistance(w1), d2 = FieldDistance(w2);
    // [D18] eq. 9, kept off the ends: a voxel at exactly zero would make triangles without area.
    constexpr float kMargin = 1e-3f;
    const float m = min(max(d1 / (d1 - d2), kMargin), 1 - kMargin);
    float n[3];
    for (int k = 0; k < 3; ++k) n[k] = (1 - m) * field.Slope(i1, k) + m * field.Slope(i2, k);
    if (n[0] * n[0] + (n[1] * n[1] + n[2] * n[2]) < 1e-12f)
        for (int k = 0; k < 3; ++k) n[k] = k != axis ? 0.0f : d2 > d1 ? 1.0f : -1.0f;
    EdgeVertex v;
    v.fraction = static_cast<std::uint16_t>(m * 65536 + 0.5f);
    EncodeNormal(n, v.normal);
    v.colour = MixColours(w1, c1, w2, c2, m);
    v.has_colour = HasIntensity(w1) || HasIntensity(w2);
    return v;
}

}  // namespace tessera
