#include "finish/smooth.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "finish/mesh_edges.h"

namespace tessera {
namespace {

constexpr float kForward = 0.5f, kBack = -0.53f;

// The vertices beside each vertex, one list after the other.
struct Neighbours {
    std::vector<std::uint32_t> first, vertices;  // of vertex v: first[v] to first[v + 1]
};

// A vertex at a border has the two beside it on the border.
Neighbours NeighboursOf(const TriangleMesh& mesh) {
    const auto triangles = TriangleNeighbours(mesh);
    std::vector<std::uint8_t> at_border(mesh.vertices.size());
    const auto corner = [&](std::size_t t, std::size_t k) { return mesh.triangles[t][k % 3]; };
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            if (triangles[t][k] == kNoTriangle)
                at_border[corner(t, k)] = at_border[corner(t, k + 1)] = 1;
    Neighbours neighbours;
    neighbours.first.resize(mesh.vertices.size() + 1);
    // Each inner edge is seen from both of its triangles, once in each direction.
    const auto for_each = [&](const auto& take) {
        for (std::size_t t = 0; t < triangles.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = corner(t, k), b = corner(t, k + 1);
                const bool border = triangles[t][k] == kNoTriangle;
                if (border || at_border[a] == 0) take(a, b);
                if (border) take(b, a);
            }
    };
    for_each([&](std::uint32_t a, std::uint32_t) { ++neighbours.first[a + 1]; });
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
        neighbours.first[v + 1] += neighbours.first[v];
    neighbours.vertices.resize(neighbours.first.back());
    std::vector<std::uint32_t> next(neighbours.first.begin(), neighbours.first.end() - 1);
    for_each([&](std::uint32_t a, std::uint32_t b) { neighbours.vertices[next[a]++] = b; });
    return neighbours;
}

}  // namespace

void Smooth(TriangleMesh& mesh, const std::vector<int>& rounds) {
    const int most = rounds.empty() ? 0 : *std::ranges::max_element(rounds);
    if (most <= 0) return;
    const Neighbours neighbours = NeighboursOf(mesh);
    std::vector<std::uint32_t> moving;
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
        if (rounds[v] > 0 && neighbours.first[v] < neighbours.first[v + 1]) moving.push_back(v);
    std::vector<Eigen::Vector3f> after = mesh.vertices;
    for (int round = 0; round < most; ++round) {
        std::erase_if(moving, [&](std::uint32_t v) { return rounds[v] <= round; });
        for (const float share : {kForward, kBack}) {
            const std::vector<Eigen::Vector3f>& before = mesh.vertices;
            tbb::parallel_for(std::size_t{0}, moving.size(), [&](std::size_t i) {
                const std::uint32_t v = moving[i];
                const std::uint32_t first = neighbours.first[v], last = neighbours.first[v + 1];
                Eigen::Vector3f mean = Eigen::Vector3f::Zero();
                for (std::uint32_t k = first; k < last; ++k) mean += before[neighbours.vertices[k]];
                mean /= static_cast<float>(last - first);
                after[v] = before[v] + share * (mean - before[v]);
            });
            tbb::parallel_for(std::size_t{0}, moving.size(),
                              [&](std::size_t i) { mesh.vertices[moving[i]] = after[moving[i]]; });
        }
    }
    mesh.normals.assign(mesh.vertices.size(), Eigen::Vector3f::Zero());
    for (const auto& triangle : mesh.triangles) {
        const Eigen::Vector3f normal = AreaNormal(mesh, triangle);
        for (const std::uint32_t v : triangle) mesh.normals[v] += normal;
    }
    for (Eigen::Vector3f& normal : mesh.normals) normal.normalize();
}

}  // namespace tessera
