// Meshes of maps and formulas, and the properties that tests check: topology, area, volume.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "mapping/analytic_fields.h"
#include "mapping/mesher.h"

namespace tessera::testing_support {

// Number of times each directed triangle side occurs.
inline std::map<std::pair<std::uint32_t, std::uint32_t>, int> DirectedEdges(
    const TriangleMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const auto& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) ++uses[{t[i], t[(i + 1) % 3]}];
    return uses;
}

// Number of edges that are not used exactly once in each direction. Edges with `allowed(a, b)` are
// not counted.
template <class Allowed>
int BadEdges(const TriangleMesh& mesh, const Allowed& allowed) {
    const auto uses = DirectedEdges(mesh);
    int bad = 0;
    for (const auto& [edge, count] : uses) {
        const auto back = uses.find({edge.second, edge.first});
        const bool good = count == 1 && back != uses.end() && back->second == 1;
        if (!good && !(count == 1 && back == uses.end() && allowed(edge.first, edge.second))) ++bad;
    }
    return bad;
}
inline int BadEdges(const TriangleMesh& mesh) {
    return BadEdges(mesh, [](std::uint32_t, std::uint32_t) { return false; });
}

inline long EulerCharacteristic(const TriangleMesh& mesh) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& [edge, count] : DirectedEdges(mesh))
        edges.insert(std::minmax(edge.first, edge.second));
    return static_cast<long>(mesh.vertices.size()) - static_cast<long>(edges.size()) +
           static_cast<long>(mesh.triangles.size());
}

// A vector along the outward normal whose length is twice the area.
inline Eigen::Vector3d TriangleCross(const TriangleMesh& mesh,
                                     const std::array<std::uint32_t, 3>& t) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    return (mesh.vertices[t[1]].cast<double>() - a).cross(mesh.vertices[t[2]].cast<double>() - a);
}
inline double Area(const TriangleMesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles) sum += TriangleCross(mesh, t).norm() / 2;
    return sum;
}
inline double Volume(const TriangleMesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles)
        sum += TriangleCross(mesh, t).dot(mesh.vertices[t[0]].cast<double>()) / 6;
    return sum;
}

inline std::size_t DistinctPositions(const TriangleMesh& mesh) {
    std::set<std::tuple<float, float, float>> positions;
    for (const auto& v : mesh.vertices) positions.insert({v.x(), v.y(), v.z()});
    return positions.size();
}

inline bool SameBytes(const TriangleMesh& a, const TriangleMesh& b) {
    return a.vertices == b.vertices && a.normals == b.normals && a.colours == b.colours &&
           a.triangles == b.triangles;
}

// The whole mesh of a map.
inline TriangleMesh MeshOf(const BlockMap& map, int min_component_triangles = 0) {
    Mesher::Config config;
    config.min_component_triangles = min_component_triangles;
    Mesher mesher(config);
    mesher.Update(map);
    return mesher.Assemble();
}

// The mesh of a formula, with 1 cm voxels and 4 cm truncation.
inline TriangleMesh MeshOf(const Sdf& sdf, const BlockCoord& low, const BlockCoord& high,
                           const Paint& paint = nullptr) {
    BlockMap map{BlockMap::Config{}};
    Fill(map, sdf, low, high, paint);
    return MeshOf(map);
}

}  // namespace tessera::testing_support
