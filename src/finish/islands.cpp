#include "finish/islands.h"

#include <algorithm>
#include <vector>

#include "finish/mesh_edges.h"
#include "finish/noise_factor.h"

namespace tessera {

RemovedIslands RemoveIslands(TriangleMesh& mesh, double least_m2, std::vector<float>& sigmas_m) {
    const auto neighbours = TriangleNeighbours(mesh);
    std::vector<std::uint32_t> piece_of(mesh.triangles.size(), kNoTriangle), open;
    std::vector<double> area_m2, weighted_m2;
    const auto factor = [&](std::uint32_t t) {
        const auto& [a, b, c] = mesh.triangles[t];
        return std::max(NoiseFactor(std::max({sigmas_m[a], sigmas_m[b], sigmas_m[c]})), 1.0f);
    };
    for (std::uint32_t seed = 0; seed < piece_of.size(); ++seed) {
        if (piece_of[seed] != kNoTriangle) continue;
        const auto piece = static_cast<std::uint32_t>(area_m2.size());
        area_m2.push_back(0);
        weighted_m2.push_back(0);
        piece_of[seed] = piece;
        open.push_back(seed);
        while (!open.empty()) {
            const std::uint32_t t = open.back();
            open.pop_back();
            const float triangle_m2 = AreaNormal(mesh, mesh.triangles[t]).norm();
            area_m2.back() += triangle_m2;
            weighted_m2.back() += sigmas_m.empty() ? triangle_m2 : triangle_m2 / factor(t);
            for (const std::uint32_t n : neighbours[t]) {
                if (n == kNoTriangle || piece_of[n] != kNoTriangle) continue;
                piece_of[n] = piece;
                open.push_back(n);
            }
        }
    }
    RemovedIslands removed;
    if (area_m2.empty()) return removed;
    const double largest_m2 = *std::ranges::max_element(area_m2);
    const auto goes = [&](std::size_t piece) {
        return weighted_m2[piece] < least_m2 && area_m2[piece] < largest_m2;
    };
    for (std::size_t piece = 0; piece < area_m2.size(); ++piece)
        if (goes(piece)) {
            ++removed.islands;
            removed.area_m2 += area_m2[piece];
        }
    std::size_t kept = 0;
    for (std::size_t t = 0; t < piece_of.size(); ++t)
        if (!goes(piece_of[t])) mesh.triangles[kept++] = mesh.triangles[t];
    removed.triangles = mesh.triangles.size() - kept;
    mesh.triangles.resize(kept);
    DropUnusedVertices(mesh, sigmas_m);
    return removed;
}

RemovedIslands RemoveIslands(TriangleMesh& mesh, double least_m2) {
    std::vector<float> none;
    return RemoveIslands(mesh, least_m2, none);
}

}  // namespace tessera
