// Tessellates the surface of the analytic scene into patches.
#include <algorithm>
#include <cmath>

#include "synth/analytic_scene.h"

namespace tessera {
namespace {

constexpr double kMaxPatch = 0.1;       // metres
constexpr double kMaxSagitta = 0.0005;  // metres

// Number of cells along an arc of `length_m` of a circle of `radius_m`.
int ArcCells(double length_m, double radius_m) {
    const double chord_angle = 2 * std::acos(std::max(1 - kMaxSagitta / radius_m, 0.0));
    const double cell = std::min(kMaxPatch, chord_angle * radius_m);
    return std::max(static_cast<int>(std::ceil(length_m / cell)), 8);
}

int FlatCells(double length_m) {
    return std::max(static_cast<int>(std::ceil(length_m / kMaxPatch)), 1);
}

bool IsCap(const Shape& shape, int chart) {
    return shape.kind == ShapeKind::kCylinder && chart > 0;
}

}  // namespace

Eigen::Vector3d AnalyticScene::PatchCorner(const Shape& shape, int number, const Chart& chart,
                                           int column, int row) {
    const double u = static_cast<double>(column) / chart.patch_columns;
    const double v = static_cast<double>(row) / chart.patch_rows;
    const Eigen::Vector2d size = ChartSize(shape, IsCap(shape, number) ? 0 : number);
    if (!IsCap(shape, number)) return PointOnChart(shape, number, {u * size.x(), v * size.y()});
    Eigen::Vector3d rim = PointOnChart(shape, 0, {u * size.x(), 0});
    rim.head<2>() *= v;
    rim.z() = number == 1 ? -shape.half_size_m.z() : shape.half_size_m.z();
    return rim;
}

void AnalyticScene::Tessellate(Part& part) {
    const Shape& shape = part.shape;
    const double radius = shape.half_size_m.x();
    for (int i = 0; i < ChartCount(shape.kind); ++i) {
        const Eigen::Vector2d size = ChartSize(shape, i);
        Chart& chart = part.charts[i];
        chart.patch_columns = FlatCells(size.x());
        chart.patch_rows = FlatCells(size.y());
        if (shape.kind == ShapeKind::kSphere) {
            chart.patch_columns = ArcCells(size.x(), radius);
            chart.patch_rows = ArcCells(size.y(), radius);
        } else if (shape.kind == ShapeKind::kCylinder) {
            // Caps are tessellated in rings around their centre, so that their rim matches the
            // side.
            chart.patch_columns = ArcCells(ChartSize(shape, 0).x(), radius);
            if (i > 0) chart.patch_rows = FlatCells(radius);
        }
        chart.first_patch = patch_count_;
        if (part.motion < 0)
            patch_count_ += static_cast<std::int64_t>(chart.patch_columns) * chart.patch_rows;
    }
}

std::int64_t AnalyticScene::PatchOf(const SurfaceHit& hit) const {
    if (parts_[hit.part].motion >= 0) return -1;
    const Shape& shape = parts_[hit.part].shape;
    const Chart& chart = parts_[hit.part].charts[hit.chart];
    const Eigen::Vector2d size = ChartSize(shape, hit.chart);
    double u = hit.u / size.x(), v = hit.v / size.y();
    if (shape.kind == ShapeKind::kCylinder && hit.chart > 0) {
        const Eigen::Vector3d p = PointOnChart(shape, hit.chart, {hit.u, hit.v});
        const Eigen::Vector2d side = ChartPoint(shape, 0, p);
        u = side.x() / ChartSize(shape, 0).x();
        v = p.head<2>().norm() / shape.half_size_m.x();
    }
    const int column =
        std::clamp(static_cast<int>(u * chart.patch_columns), 0, chart.patch_columns - 1);
    const int row = std::clamp(static_cast<int>(v * chart.patch_rows), 0, chart.patch_rows - 1);
    return chart.first_patch + static_cast<std::int64_t>(row) * chart.patch_columns + column;
}

TriangleMesh AnalyticScene::PatchMesh(const std::vector<bool>* keep) const {
    TriangleMesh mesh;
    for (const Part& part : parts_)
        if (part.motion < 0) AppendPatches(part, keep, mesh);
    return mesh;
}

TriangleMesh AnalyticScene::InstanceMesh(int instance) const {
    TriangleMesh mesh;
    for (const Part& part : parts_)
        if (part.instance == instance) AppendPatches(part, nullptr, mesh);
    return mesh;
}

// Two triangles per kept cell of the chart's grid.
void AnalyticScene::AppendChart(const Shape& shape, int number, const Chart& chart,
                                const std::vector<bool>* keep, TriangleMesh& mesh) const {
    const int columns = chart.patch_columns, rows = chart.patch_rows;
    std::vector<std::uint32_t> index(static_cast<std::size_t>(columns + 1) * (rows + 1),
                                     UINT32_MAX);
    const auto vertex = [&](int column, int row) {
        std::uint32_t& v = index[static_cast<std::size_t>(row) * (columns + 1) + column];
        if (v == UINT32_MAX) {
            v = static_cast<std::uint32_t>(mesh.vertices.size());
            const Eigen::Vector3d p = PatchCorner(shape, number, chart, column, row);
            mesh.vertices.push_back((shape.T_world_shape * p).cast<float>());
        }
        return v;
    };
    // Seen from outside, u points to the left.
    const bool from_below = IsCap(shape, number) && number == 1;
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const Eigen::Vector3f ab = mesh.vertices[b] - mesh.vertices[a],
                              ac = mesh.vertices[c] - mesh.vertices[a];
        if (ab.cross(ac).squaredNorm() < 1e-18f) return;  // at a pole or the centre of a cap
        mesh.triangles.push_back({a, from_below ? c : b, from_below ? b : c});
    };
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            if (keep &&
                !(*keep)[chart.first_patch + static_cast<std::int64_t>(row) * columns + column])
                continue;
            const std::uint32_t right = vertex(column + 1, row), down = vertex(column, row + 1);
            triangle(vertex(column, row), down, right);
            triangle(right, down, vertex(column + 1, row + 1));
        }
    }
}

void AnalyticScene::AppendPatches(const Part& part, const std::vector<bool>* keep,
                                  TriangleMesh& mesh) const {
    Shape shape = part.shape;
    if (part.motion >= 0) shape.T_world_shape = motions_[part.motion](0) * shape.T_world_shape;
    for (int i = 0; i < ChartCount(shape.kind); ++i)
        AppendChart(shape, i, part.charts[i], keep, mesh);
}

}  // namespace tessera
