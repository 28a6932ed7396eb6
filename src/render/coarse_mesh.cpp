#include "render/coarse_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace tessera {
namespace {

struct Cell {
    std::int32_t x = 0, y = 0, z = 0;
    bool operator==(const Cell&) const = default;
};

struct CellHash {
    std::size_t operator()(const Cell& c) const {
        const auto mixed =
            static_cast<std::uint64_t>(static_cast<std::uint32_t>(c.x)) * 0x9e3779b97f4a7c15u ^
            static_cast<std::uint64_t>(static_cast<std::uint32_t>(c.y)) * 0xc2b2ae3d27d4eb4fu ^
            static_cast<std::uint64_t>(static_cast<std::uint32_t>(c.z)) * 0x165667b19e3779f9u;
        return static_cast<std::size_t>(mixed ^ mixed >> 29);
    }
};

Cell CellOf(const Eigen::Vector3f& p, double cell_m) {
    constexpr double kMost = std::numeric_limits<std::int32_t>::max();
    const auto index = [&](float x) {
        return static_cast<std::int32_t>(std::clamp(std::floor(x / cell_m), -kMost, kMost));
    };
    return {index(p.x()), index(p.y()), index(p.z())};
}

}  // namespace

TriangleMesh CoarseMesh(const TriangleMesh& mesh, double cell_m) {
    TriangleMesh coarse;
    std::unordered_map<Cell, std::uint32_t, CellHash> first;
    std::vector<std::uint32_t> becomes(mesh.vertices.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const auto [cell, is_new] = first.try_emplace(
            CellOf(mesh.vertices[i], cell_m), static_cast<std::uint32_t>(coarse.vertices.size()));
        becomes[i] = cell->second;
        if (!is_new) continue;
        coarse.vertices.push_back(mesh.vertices[i]);
        if (!mesh.normals.empty()) coarse.normals.push_back(mesh.normals[i]);
        if (!mesh.colours.empty()) coarse.colours.push_back(mesh.colours[i]);
        if (!mesh.labels.empty()) coarse.labels.push_back(mesh.labels[i]);
    }
    for (const auto& [a, b, c] : mesh.triangles) {
        const std::array<std::uint32_t, 3> triangle{becomes[a], becomes[b], becomes[c]};
        if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
            coarse.triangles.push_back(triangle);
    }
    return coarse;
}

TriangleMesh CoarseMeshOf(const TriangleMesh& mesh, std::size_t most_triangles) {
    // Edge length of an even mesh with that many triangles. Cells of that size keep most vertices.
    double area_m2 = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        area_m2 += 0.5 * (mesh.vertices[b] - mesh.vertices[a])
                             .cross(mesh.vertices[c] - mesh.vertices[a])
                             .cast<double>()
                             .norm();
    return CoarseMesh(
        mesh, std::max(1e-4, 1.6 * std::sqrt(area_m2 / static_cast<double>(most_triangles))));
}

}  // namespace tessera
