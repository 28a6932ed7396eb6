#include "finish/charts.h"

#include <cmath>
#include <deque>
#include <limits>
#include <numbers>

#include "finish/cover.h"
#include "finish/mesh_edges.h"

namespace tessera {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

// A triangle that is seen more obliquely along the chart's direction gets a chart of its own.
constexpr float kLeastFacing = 0.15f;
constexpr float kMostCells = 8192;  // a side of the grid on which overlaps are looked for
constexpr float kInside = -0.05f;   // an overlap counts from this far inside, in cells

class ChartCutter {
  public:
    ChartCutter(const TriangleMesh& mesh, const ChartOptions& options)
        : mesh_(mesh),
          options_(options),
          neighbours_(TriangleNeighbours(mesh)),
          taken_(mesh.triangles.size()) {
        normals_.reserve(mesh.triangles.size());
        for (const auto& triangle : mesh.triangles) normals_.push_back(AreaNormal(mesh, triangle));
    }

    std::vector<Chart> Cut() {
        std::vector<Chart> charts;
        std::deque<std::uint32_t> seeds(mesh_.triangles.size());
        for (std::uint32_t t = 0; t < seeds.size(); ++t) seeds[t] = t;
        while (!seeds.empty()) {
            const std::uint32_t seed = seeds.front();
            seeds.pop_front();
            if (taken_[seed]) continue;
            std::vector<std::uint32_t> triangles = Grow(seed);
            Chart chart = Flatten(triangles);
            const std::size_t before = triangles.size();
            KeepDisjoint(chart, triangles, seeds);
            // What was put out may have set the size.
            if (triangles.size() != before) chart = Flatten(triangles);
            chart.triangles = std::move(triangles);
            charts.push_back(std::move(chart));
        }
        return charts;
    }

  private:
    const Vector3f& Corner(std::uint32_t triangle, int k) const {
        return mesh_.vertices[mesh_.triangles[triangle][static_cast<std::size_t>(k)]];
    }

    std::vector<std::uint32_t> Grow(std::uint32_t seed) {
        const float least = static_cast<float>(std::cos(options_.max_angle_rad));
        const float radius_m = static_cast<float>(0.5 * options_.max_side_m);
        const Vector3f centre = Corner(seed, 0);
        Vector3f sum = normals_[seed];
        std::vector<std::uint32_t> triangles{seed};
        taken_[seed] = true;
        const auto fits = [&](std::uint32_t t) {
            const Vector3f& n = normals_[t];
            if (n.dot(sum) < least * n.norm() * sum.norm()) return false;
            for (int k = 0; k < 3; ++k)
                if ((Corner(t, k) - centre).squaredNorm() > radius_m * radius_m) return false;
            return true;
        };
        for (std::size_t i = 0; i < triangles.size(); ++i)  // grows while it is walked through
            for (const std::uint32_t n : neighbours_[triangles[i]]) {
                if (n == kNoTriangle || taken_[n] || !fits(n)) continue;
                taken_[n] = true;
                sum += normals_[n];
                triangles.push_back(n);
            }
        return triangles;
    }

    // The plane, with the axes turned so that the box is small.
    Chart Flatten(const std::vector<std::uint32_t>& triangles) const {
        Vector3f axis = Vector3f::Zero();
        for (const std::uint32_t t : triangles) axis += normals_[t];
        if (triangles.size() == 1 || axis.norm() < 1e-20f) axis = normals_[triangles.front()];
        axis = axis.norm() > 1e-20f ? Vector3f(axis.normalized()) : Vector3f(Vector3f::UnitZ());
        const Vector3f first = axis.unitOrthogonal(), second = first.cross(axis);
        Chart best;
        float best_area = std::numeric_limits<float>::infinity();
        constexpr int kTurns = 12;
        for (int i = 0; i < kTurns; ++i) {
            const float angle = static_cast<float>(i * std::numbers::pi / (2 * kTurns));
            Chart chart;
            chart.right = std::cos(angle) * first + std::sin(angle) * second;
            chart.down = chart.right.cross(axis);
            const Vector3f base = Corner(triangles.front(), 0);
            Vector2f low = Vector2f::Constant(std::numeric_limits<float>::infinity()), high = -low;
            for (const std::uint32_t t : triangles)
                for (int k = 0; k < 3; ++k) {
                    const Vector3f p = Corner(t, k) - base;
                    const Vector2f at(p.dot(chart.right), p.dot(chart.down));
                    low = low.cwiseMin(at);
                    high = high.cwiseMax(at);
                }
            chart.size_m = high - low;
            chart.origin = base + low.x() * chart.right + low.y() * chart.down;
            if (chart.size_m.prod() >= best_area) continue;
            best_area = chart.size_m.prod();
            best = std::move(chart);
        }
        return best;
    }

    // Puts out what lies over a triangle before it, or is seen too obliquely. The first stays.
    void KeepDisjoint(const Chart& chart, std::vector<std::uint32_t>& triangles,
                      std::deque<std::uint32_t>& seeds) {
        if (triangles.size() == 1) return;
        const float per_m = static_cast<float>(1 / options_.cell_m);
        // Only the first triangle may be so large; then it is a chart by itself.
        if (per_m * chart.size_m.maxCoeff() > kMostCells) {
            for (std::size_t i = 1; i < triangles.size(); ++i) {
                taken_[triangles[i]] = false;
                seeds.push_back(triangles[i]);
            }
            triangles.resize(1);
            return;
        }
        const Vector3f out = chart.down.cross(chart.right);
        Image<std::uint8_t> covered(static_cast<int>(chart.size_m.x() * per_m) + 3,
                                    static_cast<int>(chart.size_m.y() * per_m) + 3);
        std::size_t kept = 0;
        for (const std::uint32_t t : triangles) {
            std::array<Vector2f, 3> corners;
            for (int k = 0; k < 3; ++k)
                corners[static_cast<std::size_t>(k)] =
                    per_m * chart.Place(Corner(t, k)) + Vector2f::Constant(0.5f);
            bool fits = kept == 0 || normals_[t].dot(out) >= kLeastFacing * normals_[t].norm();
            if (fits)
                ForEachCovered(corners, kInside, [&](int x, int y, const auto&) {
                    fits &= !covered.Contains(x, y) || covered(x, y) == 0;
                });
            if (!fits && kept > 0) {
                taken_[t] = false;
                seeds.push_back(t);
                continue;
            }
            ForEachCovered(corners, kInside, [&](int x, int y, const auto&) {
                if (covered.Contains(x, y)) covered(x, y) = 1;
            });
            triangles[kept++] = t;
        }
        triangles.resize(kept);
    }

    const TriangleMesh& mesh_;
    const ChartOptions options_;
    const std::vector<std::array<std::uint32_t, 3>> neighbours_;
    std::vector<Vector3f> normals_;  // times the area
    std::vector<bool> taken_;
};

}  // namespace

std::vector<Chart> CutCharts(const TriangleMesh& mesh, const ChartOptions& options) {
    return ChartCutter(mesh, options).Cut();
}

}  // namespace tessera
