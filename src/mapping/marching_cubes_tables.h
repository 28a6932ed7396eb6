// Marching cubes case tables, generated from one rule instead of typed in: on every face of a cell,
// one segment cuts off each run of inside corners. On an ambiguous face (two inside corners on a
// diagonal) this separates the inside corners. The rule depends on nothing but the face, so the two
// cells that share it agree: no cracks.
#pragma once

#include <array>
#include <cstdint>

namespace tessera {

// Corner c of a cell lies at (c & 1, c >> 1 & 1, c >> 2). Bit c of a configuration is set if corner
// c is inside, that is, if its distance is negative.
inline constexpr int kCubeConfigurations = 256;

// Edge 4 * axis + k starts at `corner`, the k-th corner whose bit `axis` is 0, and runs along
// +axis.
inline constexpr int kCubeEdges = 12;
struct CubeEdge {
    std::uint8_t axis, corner;
};
constexpr CubeEdge CubeEdgeAt(int edge) {
    const int axis = edge / 4, k = edge % 4;
    const int below = (1 << axis) - 1;
    return {static_cast<std::uint8_t>(axis),
            static_cast<std::uint8_t>(((k & ~below) << 1) | (k & below))};
}

// The segments of a configuration on face 2 * axis + side. Each connects two edges.
struct FaceSegments {
    int count = 0;
    std::array<std::array<std::uint8_t, 2>, 2> segment{};
};
FaceSegments CubeFaceSegments(int configuration, int face);

// The surface in one cell: triangles whose corners lie on the given edges, counter-clockwise seen
// from the positive side. A triangle side lies in a face only along one of the face's segments. So
// exactly two triangles share every side: two of this cell, or one of this cell and one of the
// neighbour.
struct CubeCase {
    static constexpr int kMaxTriangles = kCubeEdges - 2;
    std::uint8_t triangle_count = 0;
    std::array<std::array<std::uint8_t, 3>, kMaxTriangles> triangles{};
};
const std::array<CubeCase, kCubeConfigurations>& CubeCases();

}  // namespace tessera
