#include "report/view_up.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/mean_up.h"

namespace tessera {

Eigen::Vector3d EstimateUp(const TriangleMesh& mesh, const std::vector<StampedPose>& path) {
    constexpr double kLeastShare = 0.03;  // of the mesh's area
    Eigen::Vector3d up = Eigen::Vector3d::Zero();
    if (const std::optional<Eigen::Vector3d> mean = MeanUp(path, mesh))
        up = *mean;
    else
        for (const StampedPose& pose : path) up -= pose.T_world_camera.linear().col(1);
    if (up.norm() < 1e-9) up = -Eigen::Vector3d::UnitY();
    up.normalize();
    // Narrower in each turn: the first mean is off by as much as the camera looks down.
    for (const double within_deg : {35.0, 15.0, 7.0}) {
        const double least_cos = std::cos(within_deg * std::numbers::pi / 180);
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        double all = 0, near = 0;
        for (const auto& [a, b, c] : mesh.triangles) {
            const Eigen::Vector3f& p = mesh.vertices[a];
            const Eigen::Vector3d area =
                (mesh.vertices[b] - p).cross(mesh.vertices[c] - p).cast<double>();
            const double size = area.norm();
            if (!std::isfinite(size)) continue;
            all += size;
            if (area.dot(up) < least_cos * size) continue;
            near += size;
            sum += area;
        }
        if (near <= kLeastShare * all || sum.norm() <= 0) break;
        up = sum.normalized();
    }
    return up;
}

}  // namespace tessera
