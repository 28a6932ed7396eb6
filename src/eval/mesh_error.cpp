#include "eval/mesh_error.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/check.h"
#include "render/triangle_scene.h"

namespace tessera {
namespace {

constexpr std::size_t kGrain = 1024;

// The distance from each point to the scene; infinite if it exceeds max_distance_m.
template <class Point>
std::vector<double> Distances(const std::vector<Point>& points, const TriangleScene& scene,
                              double max_distance_m) {
    std::vector<double> distances(points.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), kGrain),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t i = range.begin(); i != range.end(); ++i) {
                              const Eigen::Vector3d p = points[i].template cast<double>();
                              distances[i] = scene.Nearest(p, max_distance_m).distance_m;
                          }
                      });
    return distances;
}

Eigen::Vector3d Corner(const TriangleMesh& mesh, std::size_t triangle, std::size_t corner) {
    return mesh.vertices[mesh.triangles[triangle][corner]].cast<double>();
}

double TwiceArea(const TriangleMesh& mesh, std::size_t triangle) {
    const Eigen::Vector3d a = Corner(mesh, triangle, 0);
    return (Corner(mesh, triangle, 1) - a).cross(Corner(mesh, triangle, 2) - a).norm();
}

double Completeness(const TriangleMesh& mesh, const TriangleMesh& reference,
                    const MeshErrorOptions& options) {
    const auto samples = SampleSurface(reference, options.completeness_samples);
    if (samples.empty()) return 0;
    TriangleScene scene(mesh);
    if (mesh.triangles.empty()) {
        TriangleMesh points;  // each vertex as a degenerate triangle
        points.vertices = mesh.vertices;
        for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i)
            points.triangles.push_back({i, i, i});
        scene = TriangleScene(points);
    }
    const auto distances = Distances(samples, scene, options.completeness_distance_m);
    const auto covered = std::count_if(distances.begin(), distances.end(),
                                       [](double d) { return std::isfinite(d); });
    return static_cast<double>(covered) / static_cast<double>(samples.size());
}

}  // namespace

Result<MeshErrorResult> MeasureMeshError(const TriangleMesh& mesh, const TriangleMesh& reference,
                                         const MeshErrorOptions& options) {
    if (mesh.vertices.empty()) return Status::Error("the mesh has no vertices to measure");
    if (reference.triangles.empty())
        return Status::Error("the reference has no triangles to measure against");
    const TriangleMesh moved = TransformMesh(mesh, options.T_reference_mesh);
    std::vector<double> distances = Distances(moved.vertices, TriangleScene(reference),
                                              std::numeric_limits<double>::infinity());
    MeshErrorResult result;
    for (const double distance : distances)
        result.distances_m.push_back(static_cast<float>(distance));
    result.accuracy_m = Summarise(std::move(distances));
    if (!std::isfinite(result.accuracy_m.max))
        return Status::Error("coordinates are too large to measure; are both meshes in metres?");
    result.completeness = Completeness(moved, reference, options);
    return result;
}

std::vector<Eigen::Vector3d> SampleSurface(const TriangleMesh& mesh, int count) {
    TESSERA_CHECK(count > 0, "{} samples", count);
    double total = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) total += TwiceArea(mesh, i);
    std::vector<Eigen::Vector3d> points;
    if (!(total > 0)) return points;
    // Samples the cumulative area in equal steps. Within a triangle, the sequence of the plastic
    // number (Roberts 2018) distributes the points.
    const double step = total / count;
    double before = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const double after = before + TwiceArea(mesh, i);
        while (static_cast<int>(points.size()) < count &&
               (static_cast<double>(points.size()) + 0.5) * step < after) {
            const double n = static_cast<double>(points.size() + 1);
            double u = std::fmod(n * 0.7548776662466927, 1.0);
            double v = std::fmod(n * 0.5698402909980532, 1.0);
            if (u + v > 1) {
                u = 1 - u;
                v = 1 - v;
            }
            const Eigen::Vector3d a = Corner(mesh, i, 0);
            points.push_back(a + u * (Corner(mesh, i, 1) - a) + v * (Corner(mesh, i, 2) - a));
        }
        before = after;
    }
    return points;
}

TriangleMesh TransformMesh(const TriangleMesh& mesh, const Eigen::Isometry3d& T_target_mesh) {
    TriangleMesh moved = mesh;
    for (Eigen::Vector3f& vertex : moved.vertices)
        vertex = (T_target_mesh * Eigen::Vector3d(vertex.cast<double>())).cast<float>();
    const Eigen::Matrix3f R = T_target_mesh.linear().cast<float>();
    for (Eigen::Vector3f& normal : moved.normals) normal = R * normal;
    return moved;
}

Rgb8 ErrorColour(double error_m, double max_m) {
    const double t = std::clamp(error_m / max_m, 0.0, 1.0);
    const auto byte = [](double x) {
        return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0, 1.0)));
    };
    return {byte(4 * t - 2), byte(t < 0.5 ? 4 * t : 4 - 4 * t), byte(2 - 4 * t)};
}

std::vector<Rgb8> ErrorColours(const std::vector<float>& errors_m, double max_m) {
    TESSERA_CHECK(max_m > 0, "max {} m", max_m);
    std::vector<Rgb8> colours;
    for (const float error_m : errors_m)
        colours.push_back(ErrorColour(static_cast<double>(error_m), max_m));
    return colours;
}

std::string MeshErrorJson(const MeshErrorResult& result) {
    const nlohmann::ordered_json json = {
        {"accuracy_mean_m", result.accuracy_m.mean}, {"accuracy_std_m", result.accuracy_m.std},
        {"accuracy_max_m", result.accuracy_m.max},   {"accuracy_rmse_m", result.accuracy_m.rmse},
        {"completeness_5cm", result.completeness},   {"points", result.distances_m.size()}};
    return json.dump(2) + "\n";
}

}  // namespace tessera
