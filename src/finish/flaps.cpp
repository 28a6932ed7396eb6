#include "finish/flaps.h"

#include <tbb/parallel_for.h>

#include <vector>

#include "finish/mesh_edges.h"

namespace tessera {
namespace {

// Keeps the triangles that do not go.
std::size_t Drop(TriangleMesh& mesh, const std::vector<std::uint8_t>& goes, double& area_m2) {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < goes.size(); ++t) {
        if (goes[t] == 0)
            mesh.triangles[kept++] = mesh.triangles[t];
        else
            area_m2 += static_cast<double>(AreaNormal(mesh, mesh.triangles[t]).norm());
    }
    const std::size_t dropped = mesh.triangles.size() - kept;
    mesh.triangles.resize(kept);
    return dropped;
}

std::vector<std::uint8_t> SeenThrough(const TriangleMesh& mesh, const FrameEvidence& evidence) {
    std::vector<std::uint8_t> through(mesh.vertices.size()), goes;
    tbb::parallel_for(std::size_t{0}, through.size(), [&](std::size_t v) {
        const Evidence there = evidence.At(mesh.vertices[v]);
        through[v] = there.seen_through > there.confirmed;
    });
    for (const auto& [a, b, c] : mesh.triangles)
        goes.push_back(through[a] + through[b] + through[c] >= 2);
    return goes;
}

std::vector<std::uint8_t> Fringe(const TriangleMesh& mesh) {
    const auto neighbours = TriangleNeighbours(mesh);
    std::vector<std::uint8_t> goes(mesh.triangles.size());
    std::vector<std::uint8_t> held(mesh.triangles.size());  // by how many edges
    std::vector<std::uint32_t> open;
    for (std::uint32_t t = 0; t < held.size(); ++t) {
        for (const std::uint32_t n : neighbours[t])
            if (n != kNoTriangle) ++held[t];
        if (held[t] < 2) open.push_back(t);
    }
    while (!open.empty()) {
        const std::uint32_t t = open.back();
        open.pop_back();
        if (goes[t] != 0) continue;
        goes[t] = 1;
        for (const std::uint32_t n : neighbours[t])
            if (n != kNoTriangle && goes[n] == 0 && --held[n] < 2) open.push_back(n);
    }
    return goes;
}

}  // namespace

RemovedFlaps RemoveFlaps(TriangleMesh& mesh, const FrameEvidence& evidence) {
    RemovedFlaps removed;
    if (evidence.frames() > 0)
        removed.triangles = Drop(mesh, SeenThrough(mesh, evidence), removed.area_m2);
    removed.fringe = Drop(mesh, Fringe(mesh), removed.area_m2);
    DropUnusedVertices(mesh);
    return removed;
}

}  // namespace tessera
