// Triangles for the inside of a polygon in the plane.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tessera {

struct PolygonMesh {
    static constexpr std::uint32_t kNone = 0xffffffffu;
    using Corners = std::array<std::uint32_t, 3>;

    std::vector<Eigen::Vector2d> points;  // those of the polygon, in its order, then inner ones
    std::vector<Corners> triangles;       // counter-clockwise
    std::vector<Corners> neighbours;      // [k] beyond the edge from corner k to k + 1, or kNone
};

// The constrained Delaunay triangulation of a polygon, which goes counter-clockwise, and of points
// inside it on a hexagonal grid `spacing` apart; farther apart where there would be more than about
// five per corner of the polygon. None if the polygon has fewer than three corners or no area,
// meets or crosses itself, or goes clockwise. Takes time with the square of the number of corners.
// Thread-safe.
std::optional<PolygonMesh> MeshPolygon(std::span<const Eigen::Vector2d> polygon, double spacing);

}  // namespace tessera
