#include "finish/fair_heights.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace tessera {
namespace {

using Eigen::Vector2d;
constexpr double kThinnestPart = 1e-3;  // of its edge's length: flatter triangles have no slope

// A jump of the slope as a linear function of up to four heights, less `known`.
struct SlopeJump {
    std::array<std::uint32_t, 4> points{};
    std::array<double, 4> factors{};
    double known = 0;
    double area = 0;  // of the triangles beside the edge

    // Adds sign times the slope along `direction` of triangle t, whose corners from k on have these
    // places in `points`. False if it is too thin.
    bool AddTriangle(const PolygonMesh& mesh, std::uint32_t t, std::uint32_t k,
                     const Vector2d& direction, double sign,
                     const std::array<std::uint32_t, 3>& places) {
        std::array<Vector2d, 3> p;
        for (std::uint32_t i = 0; i < 3; ++i) {
            points[places[i]] = mesh.triangles[t][(k + i) % 3];
            p[i] = mesh.points[points[places[i]]];
        }
        const Vector2d u = p[1] - p[0], v = p[2] - p[0];
        const double twice = u.x() * v.y() - u.y() * v.x();
        if (!(twice > kThinnestPart * u.squaredNorm())) return false;
        area += twice / 2;
        for (std::uint32_t i = 0; i < 3; ++i) {
            // A corner's weight grows across the opposite edge.
            const Vector2d opposite = p[(i + 2) % 3] - p[(i + 1) % 3];
            factors[places[i]] +=
                sign * Vector2d(-opposite.y(), opposite.x()).dot(direction) / twice;
        }
        return true;
    }
};

}  // namespace

std::optional<std::vector<double>> FairHeights(const PolygonMesh& mesh, std::span<const double> rim,
                                               std::span<const Vector2d> slopes) {
    std::vector<double> heights(mesh.points.size(), 0.0);
    std::ranges::copy(rim, heights.begin());
    const std::size_t fixed = rim.size();
    const auto unknown = static_cast<Eigen::Index>(heights.size() - fixed);
    if (unknown == 0) return heights;
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(unknown);
    const auto add = [&](const SlopeJump& jump, double edge_squared, std::size_t count) {
        const double weight = edge_squared / jump.area;
        double known = jump.known;
        for (std::size_t i = 0; i < count; ++i)
            if (jump.points[i] < fixed) known += jump.factors[i] * heights[jump.points[i]];
        for (std::size_t i = 0; i < count; ++i) {
            if (jump.points[i] < fixed) continue;
            const auto row = static_cast<Eigen::Index>(jump.points[i] - fixed);
            right[row] -= weight * jump.factors[i] * known;
            for (std::size_t k = 0; k < count; ++k)
                if (jump.points[k] >= fixed)
                    entries.emplace_back(row, static_cast<Eigen::Index>(jump.points[k] - fixed),
                                         weight * jump.factors[i] * jump.factors[k]);
        }
    };
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t beyond = mesh.neighbours[t][k];
            if (beyond != PolygonMesh::kNone && beyond < t) continue;
            const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
            const Vector2d edge = mesh.points[b] - mesh.points[a];
            const Vector2d across = Vector2d(-edge.y(), edge.x()).normalized();
            SlopeJump jump;
            if (!jump.AddTriangle(mesh, t, k, across, 1, {0, 1, 2})) continue;
            if (beyond == PolygonMesh::kNone) {
                if (slopes.empty()) continue;
                jump.known = -0.5 * (slopes[a] + slopes[b]).dot(across);
                add(jump, edge.squaredNorm(), 3);
                continue;
            }
            std::uint32_t m = 0;
            while (mesh.neighbours[beyond][m] != t) ++m;
            if (jump.AddTriangle(mesh, beyond, m, across, -1, {1, 0, 3}))
                add(jump, edge.squaredNorm(), 4);
        }
    Eigen::SparseMatrix<double> matrix(unknown, unknown);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
    if (solver.info() != Eigen::Success) return std::nullopt;
    const Eigen::VectorXd solution = solver.solve(right);
    if (!solution.allFinite()) return std::nullopt;
    for (Eigen::Index i = 0; i < unknown; ++i)
        heights[fixed + static_cast<std::size_t>(i)] = solution[i];
    return heights;
}

}  // namespace tessera
