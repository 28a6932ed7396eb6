#include "finish/decimate.h"

#include <meshoptimizer.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "finish/mesh_edges.h"

namespace tessera {
namespace {

constexpr double kAnyError_m = 1e6;

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

// Decimates some of a mesh's triangles, and raises `reached_m` to the error. With
// meshopt_SimplifyLockBorder among the options, the edges stay where these triangles border on
// nothing or on others.
Triangles Thin(const TriangleMesh& mesh, Triangles triangles, double error_m, double share,
               unsigned int options, double& reached_m) {
    // Only the vertices that they use: meshoptimizer's tables are as long as the list.
    constexpr std::uint32_t kUnused = 0xffffffffu;
    std::vector<std::uint32_t> number_of(mesh.vertices.size(), kUnused), used;
    for (const auto& triangle : triangles)
        for (const std::uint32_t vertex : triangle) number_of[vertex] = 0;
    for (std::uint32_t v = 0; v < number_of.size(); ++v) {
        if (number_of[v] == kUnused) continue;
        number_of[v] = static_cast<std::uint32_t>(used.size());
        used.push_back(v);
    }
    for (auto& triangle : triangles)
        for (std::uint32_t& vertex : triangle) vertex = number_of[vertex];
    std::vector<Eigen::Vector3f> points;
    for (const std::uint32_t vertex : used) points.push_back(mesh.vertices[vertex]);
    static_assert(sizeof(triangles[0]) == 3 * sizeof(unsigned int) &&
                  sizeof(points[0]) == 3 * sizeof(float));
    const float* positions = points.front().data();
    const std::size_t stride = sizeof(points[0]);
    // meshoptimizer's errors are shares of the extent.
    const float extent_m = meshopt_simplifyScale(positions, points.size(), stride);
    const auto target = static_cast<std::size_t>(share * static_cast<double>(triangles.size()));
    float reached = 0;
    Triangles kept(triangles.size());
    const std::size_t count =
        meshopt_simplify(kept.front().data(), triangles.front().data(), 3 * triangles.size(),
                         positions, points.size(), stride, 3 * target,
                         static_cast<float>(error_m) / extent_m, options, &reached);
    kept.resize(count / 3);
    for (auto& triangle : kept)
        for (std::uint32_t& vertex : triangle) vertex = used[vertex];
    reached_m = std::max(reached_m, static_cast<double>(reached) * static_cast<double>(extent_m));
    return kept;
}

}  // namespace

bool DecimationAvailable() { return true; }

double Decimate(TriangleMesh& mesh, const std::vector<float>& sigmas_m, double error_m,
                double share) {
    // Classes of triangles: up to error_m, twice it, four times it ...
    std::vector<Triangles> classes;
    for (const auto& triangle : mesh.triangles) {
        float sigma_m = 0;
        for (const std::uint32_t v : triangle) sigma_m = std::max(sigma_m, sigmas_m[v]);
        const double doublings =
            std::log2(std::max(0.5 * static_cast<double>(sigma_m) / error_m, 1.0));
        const auto number = static_cast<std::size_t>(std::min(doublings, 30.0));
        if (number >= classes.size()) classes.resize(number + 1);
        classes[number].push_back(triangle);
    }
    const unsigned int options = classes.size() > 1 ? meshopt_SimplifyLockBorder : 0;
    std::vector<double> reached_m(classes.size());
    tbb::parallel_for(std::size_t{0}, classes.size(), [&](std::size_t i) {
        if (classes[i].empty()) return;
        classes[i] = Thin(mesh, std::move(classes[i]), std::ldexp(error_m, static_cast<int>(i)),
                          share, options, reached_m[i]);
    });
    mesh.triangles.clear();
    for (const Triangles& kept : classes)
        mesh.triangles.insert(mesh.triangles.end(), kept.begin(), kept.end());
    DropUnusedVertices(mesh);
    return reached_m.empty() ? 0 : *std::ranges::max_element(reached_m);
}

double DecimateTo(TriangleMesh& mesh, double share) {
    if (mesh.triangles.empty()) return 0;
    double reached_m = 0;
    mesh.triangles = Thin(mesh, std::move(mesh.triangles), kAnyError_m, share, 0, reached_m);
    DropUnusedVertices(mesh);
    return reached_m;
}

}  // namespace tessera
