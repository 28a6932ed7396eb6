#include "finish/mesh_edges.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <span>
#include <tuple>

namespace tessera {
namespace {

// A side of a triangle, by the one of its vertices that has the larger number.
struct HalfEdge {
    std::uint32_t high;
    std::uint32_t triangle, side;
};

template <class T>
void Keep(std::vector<T>& values, const std::vector<std::uint32_t>& number_of, std::size_t count) {
    if (values.empty()) return;
    for (std::size_t i = 0; i < number_of.size(); ++i)
        if (number_of[i] != kNoTriangle) values[number_of[i]] = values[i];
    values.resize(count);
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> TriangleNeighbours(const TriangleMesh& mesh) {
    const auto for_each_side = [&](const auto& take) {
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
            for (std::uint32_t k = 0; k < 3; ++k) {
                const auto [low, high] =
                    std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
                take(low, HalfEdge{high, t, k});
            }
    };
    // The sides of each vertex, one list after the other: of v from first[v] to first[v + 1].
    std::vector<std::size_t> first(mesh.vertices.size() + 2);
    for_each_side([&](std::uint32_t low, const HalfEdge&) { ++first[low + 2]; });
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<HalfEdge> edges(3 * mesh.triangles.size());
    for_each_side([&](std::uint32_t low, const HalfEdge& edge) { edges[first[low + 1]++] = edge; });
    std::vector<std::array<std::uint32_t, 3>> neighbours(mesh.triangles.size(),
                                                         {kNoTriangle, kNoTriangle, kNoTriangle});
    tbb::parallel_for(std::size_t{0}, mesh.vertices.size(), [&](std::size_t v) {
        const std::span<HalfEdge> sides(edges.data() + first[v], first[v + 1] - first[v]);
        std::ranges::sort(sides, {},
                          [](const HalfEdge& e) { return std::tuple(e.high, e.triangle, e.side); });
        for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
            const HalfEdge &a = sides[i], &b = sides[i + 1];
            if (a.high != b.high) continue;
            neighbours[a.triangle][a.side] = b.triangle;
            neighbours[b.triangle][b.side] = a.triangle;
            ++i;
        }
    });
    return neighbours;
}

void DropUnusedVertices(TriangleMesh& mesh) {
    std::vector<float> none;
    DropUnusedVertices(mesh, none);
}

void DropUnusedVertices(TriangleMesh& mesh, std::vector<float>& property) {
    std::vector<std::uint32_t> number_of(mesh.vertices.size(), kNoTriangle);
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t vertex : triangle) number_of[vertex] = 0;
    std::uint32_t count = 0;
    for (std::uint32_t& number : number_of)
        if (number == 0) number = count++;
    Keep(mesh.vertices, number_of, count);
    Keep(mesh.normals, number_of, count);
    Keep(mesh.colours, number_of, count);
    Keep(mesh.labels, number_of, count);
    Keep(property, number_of, count);
    for (auto& triangle : mesh.triangles)
        for (std::uint32_t& vertex : triangle) vertex = number_of[vertex];
}

Eigen::Vector3f AreaNormal(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
    const Eigen::Vector3f& a = mesh.vertices[triangle[0]];
    return 0.5f * (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a);
}

}  // namespace tessera
