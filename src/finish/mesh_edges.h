// Which triangles of a mesh share edges.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh.h"

namespace tessera {

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

// Per triangle, the triangle at each edge: [k] lies beyond the edge from corner k to corner k + 1;
// kNoTriangle at a border. Where more than two triangles share an edge, pairs of them are joined.
std::vector<std::array<std::uint32_t, 3>> TriangleNeighbours(const TriangleMesh& mesh);

// Drops the vertices that no triangle uses, with all their properties, and keeps the order of the
// others.
void DropUnusedVertices(TriangleMesh& mesh);
// `property`: one per vertex, or none.
void DropUnusedVertices(TriangleMesh& mesh, std::vector<float>& property);

// The triangle's normal times its area, out of the surface.
Eigen::Vector3f AreaNormal(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle);

}  // namespace tessera
