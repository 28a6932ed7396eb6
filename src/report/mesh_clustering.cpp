#include "report/mesh_clustering.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace tessera {
namespace {

constexpr std::uint32_t kDropped = std::numeric_limits<std::uint32_t>::max();

Eigen::AlignedBox3d BoxOf(const TriangleMesh& mesh) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3f& p : mesh.vertices)
        if (p.allFinite()) box.extend(p.cast<double>());
    return box;
}

// Finite vertices with the number of their cell, sorted by it and then by their own.
std::vector<std::pair<std::uint64_t, std::uint32_t>> VerticesByCell(const TriangleMesh& mesh,
                                                                    double cell_m) {
    constexpr double kMostCells = (1 << 21) - 1;  // per axis: three numbers fit 64 bits
    const Eigen::AlignedBox3d box = BoxOf(mesh);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted;
    sorted.reserve(mesh.vertices.size());
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
        if (!mesh.vertices[v].allFinite()) continue;
        const Eigen::Vector3d cell = (mesh.vertices[v].cast<double>() - box.min()) / cell_m;
        std::uint64_t key = 0;
        for (const double x : {cell.x(), cell.y(), cell.z()})
            key = key << 21 | static_cast<std::uint64_t>(std::min(std::floor(x), kMostCells));
        sorted.emplace_back(key, v);
    }
    std::ranges::sort(sorted);
    return sorted;
}

// Sums of one cell's vertices.
struct Cell {
    Eigen::Vector3d position = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
    std::array<std::uint64_t, 3> colour{};
    std::uint64_t count = 0;
    VertexLabel label;

    void Add(const TriangleMesh& mesh, std::uint32_t v) {
        if (count++ == 0 && !mesh.labels.empty()) label = mesh.labels[v];
        position += mesh.vertices[v].cast<double>();
        if (!mesh.normals.empty()) normal += mesh.normals[v].cast<double>();
        if (mesh.colours.empty()) return;
        const Rgb8& c = mesh.colours[v];
        colour = {colour[0] + c.r, colour[1] + c.g, colour[2] + c.b};
    }
    void MoveTo(const TriangleMesh& like, TriangleMesh& mesh) const {
        const auto mean = [&](std::uint64_t sum) {
            return static_cast<std::uint8_t>((sum + count / 2) / count);
        };
        mesh.vertices.emplace_back((position / static_cast<double>(count)).cast<float>());
        if (!like.normals.empty()) mesh.normals.emplace_back(normal.normalized().cast<float>());
        if (!like.colours.empty())
            mesh.colours.push_back({mean(colour[0]), mean(colour[1]), mean(colour[2])});
        if (!like.labels.empty()) mesh.labels.push_back(label);
    }
};

double AreaOf(const TriangleMesh& mesh) {
    double area_m2 = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Eigen::Vector3f& p = mesh.vertices[a];
        const double area = (mesh.vertices[b] - p).cross(mesh.vertices[c] - p).norm() / 2;
        if (std::isfinite(area)) area_m2 += area;
    }
    return area_m2;
}

TriangleMesh EveryNth(const TriangleMesh& points, std::size_t n) {
    TriangleMesh some;
    for (std::size_t i = 0; i < points.vertices.size(); i += n) {
        some.vertices.push_back(points.vertices[i]);
        if (!points.normals.empty()) some.normals.push_back(points.normals[i]);
        if (!points.colours.empty()) some.colours.push_back(points.colours[i]);
        if (!points.labels.empty()) some.labels.push_back(points.labels[i]);
    }
    return some;
}

}  // namespace

TriangleMesh ClusterVertices(const TriangleMesh& mesh, double cell_m) {
    TriangleMesh clustered;
    std::vector<std::uint32_t> becomes(mesh.vertices.size(), kDropped);
    const auto sorted = VerticesByCell(mesh, cell_m);
    for (std::size_t i = 0; i < sorted.size();) {
        Cell cell;
        const auto number = static_cast<std::uint32_t>(clustered.vertices.size());
        for (const std::uint64_t key = sorted[i].first; i < sorted.size() && sorted[i].first == key;
             ++i) {
            cell.Add(mesh, sorted[i].second);
            becomes[sorted[i].second] = number;
        }
        cell.MoveTo(mesh, clustered);
    }
    for (const auto& [a, b, c] : mesh.triangles) {
        const std::array<std::uint32_t, 3> t{becomes[a], becomes[b], becomes[c]};
        const bool whole = std::ranges::find(t, kDropped) == t.end();
        if (whole && t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) clustered.triangles.push_back(t);
    }
    return clustered;
}

ReducedMesh ReduceMesh(TriangleMesh mesh, std::size_t most_triangles) {
    const std::size_t most = std::max<std::size_t>(1, most_triangles);
    if (mesh.triangles.empty() && mesh.vertices.size() > most)
        return {EveryNth(mesh, (mesh.vertices.size() + most - 1) / most), 0};
    if (mesh.triangles.size() <= most) return {std::move(mesh), 0};
    // A grid cuts a surface into about one vertex, so two triangles, per square of a cell.
    const double smallest_m = std::max(1e-6, BoxOf(mesh).sizes().maxCoeff() * 1e-6);
    double cell_m = std::max(smallest_m, std::sqrt(2 * AreaOf(mesh) / static_cast<double>(most)));
    for (;; cell_m *= 1.15) {
        TriangleMesh smaller = ClusterVertices(mesh, cell_m);
        if (smaller.triangles.size() <= most) return {std::move(smaller), cell_m};
    }
}

}  // namespace tessera
