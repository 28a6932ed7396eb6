// A mesh in few bytes, for a page that carries it as text: 12 bytes per vertex and one to three per
// corner of a triangle. Pure functions, thread-safe; the same mesh gives the same bytes.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/mesh.h"

namespace tessera {

struct PackedMesh {
    // position = low + step * code per axis, codes 0 to 65535; metres.
    Eigen::Vector3d low = Eigen::Vector3d::Zero(), step = Eigen::Vector3d::Ones();
    // Per vertex, little endian: x y z (uint16), octahedral normal (2 x int8, 127 = 1), r g b, and
    // the label: 0 = none, else 1 + position in `classes`.
    std::vector<std::uint8_t> vertices;
    // Per corner: how far its vertex lies behind the number of vertices seen before, as a
    // variable-length number (7 bits a byte, the lowest first, the top bit set except in the last).
    // 0 is the next new vertex: vertices are in the order of their first use.
    std::vector<std::uint8_t> corners;
    std::size_t vertex_count = 0, triangle_count = 0;
    std::vector<int> classes;  // class numbers, ascending; the first 255
};

inline constexpr std::size_t kPackedVertexBytes = 12;

// Leaves out what is not finite, and vertices of no triangle if there are triangles. Computes
// normals if the mesh has none. Without colours, vertices are grey.
PackedMesh PackMesh(const TriangleMesh& mesh);

// Octahedral encoding (Meyer et al. 2010): the unit vector's projection on |x|+|y|+|z| = 1, the
// lower half folded outwards; x and y in [-1, 1].
Eigen::Vector2f OctahedralOf(const Eigen::Vector3f& normal);

}  // namespace tessera
