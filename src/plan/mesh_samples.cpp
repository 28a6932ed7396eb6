#include "plan/mesh_samples.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/quantile.h"

namespace tessera {
namespace {

constexpr float kFar_m = 500;  // from the middle of the mesh; no building, but debris
constexpr double kMostSurface_m2 = 1e6;
constexpr double kMostSamples = 6e6;
constexpr double kFinest_m = 0.01;
constexpr float kSmallTriangle_m = 0.1F;  // larger ones are flat by intent: corners are not smooth

// The median of the finite vertices per axis: far debris does not move it.
Eigen::Vector3f MiddleOf(const TriangleMesh& mesh) {
    constexpr std::size_t kEnough = 100'000;
    const std::size_t step = mesh.vertices.size() / kEnough + 1;
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<float> values;
        for (std::size_t i = 0; i < mesh.vertices.size(); i += step)
            if (mesh.vertices[i].allFinite()) values.push_back(mesh.vertices[i][axis]);
        if (values.empty()) return middle;
        middle[axis] = Median(values);
    }
    return middle;
}

struct SampledTriangle {
    Eigen::Vector3f a, ab, ac, normal;
    double area_m2 = 0;
};

class TriangleReader {
  public:
    explicit TriangleReader(const TriangleMesh& mesh)
        : mesh_(mesh),
          middle_(MiddleOf(mesh)),
          normals_(mesh.normals.size() == mesh.vertices.size()) {}

    // False if the triangle is no surface, or none that can be used.
    bool Read(const std::array<std::uint32_t, 3>& corners, SampledTriangle& triangle) const {
        for (const std::uint32_t corner : corners) {
            if (corner >= mesh_.vertices.size()) return false;
            const Eigen::Vector3f off = mesh_.vertices[corner] - middle_;
            if (!off.allFinite() || off.cwiseAbs().maxCoeff() > kFar_m) return false;
        }
        triangle.a = mesh_.vertices[corners[0]];
        triangle.ab = mesh_.vertices[corners[1]] - triangle.a;
        triangle.ac = mesh_.vertices[corners[2]] - triangle.a;
        const Eigen::Vector3f cross = triangle.ab.cross(triangle.ac);
        triangle.area_m2 = 0.5 * static_cast<double>(cross.norm());
        if (triangle.area_m2 == 0) return true;
        triangle.normal = cross.normalized();
        const float side =
            std::max(triangle.ab.cwiseAbs().maxCoeff(), triangle.ac.cwiseAbs().maxCoeff());
        if (!normals_ || side > kSmallTriangle_m) return true;
        const Eigen::Vector3f sum =
            mesh_.normals[corners[0]] + mesh_.normals[corners[1]] + mesh_.normals[corners[2]];
        if (sum.allFinite() && sum.norm() > 0.5F) triangle.normal = sum.normalized();
        return true;
    }

  private:
    const TriangleMesh& mesh_;
    Eigen::Vector3f middle_;
    bool normals_;
};

}  // namespace

Result<MeshSamples> SampleMesh(const TriangleMesh& mesh) {
    const TriangleReader reader(mesh);
    MeshSamples samples;
    SampledTriangle triangle;
    double surface_m2 = 0;
    for (const auto& corners : mesh.triangles)
        if (reader.Read(corners, triangle))
            surface_m2 += triangle.area_m2;
        else
            ++samples.skipped;
    if (surface_m2 == 0) return Status::Error("there is no surface in it; is it an empty mesh?");
    if (surface_m2 > kMostSurface_m2)
        return Status::Error(fmt::format(
            "{:.3g} square metres of surface are no building; is it in millimetres?", surface_m2));
    samples.spacing_m = std::max(kFinest_m, std::sqrt(surface_m2 / kMostSamples));
    const double piece_m2 = samples.spacing_m * samples.spacing_m;
    double carried_m2 = piece_m2 / 2, number = 0;
    for (const auto& corners : mesh.triangles) {
        if (!reader.Read(corners, triangle)) continue;
        for (carried_m2 += triangle.area_m2; carried_m2 >= piece_m2; carried_m2 -= piece_m2) {
            // A sequence that fills the triangle evenly.
            number += 1;
            double u = number * 0.7548776662466927, v = number * 0.5698402909980532;
            u -= std::floor(u);
            v -= std::floor(v);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            samples.surface.vertices.emplace_back(triangle.a + static_cast<float>(u) * triangle.ab +
                                                  static_cast<float>(v) * triangle.ac);
            samples.surface.normals.push_back(triangle.normal);
        }
    }
    return samples;
}

}  // namespace tessera
