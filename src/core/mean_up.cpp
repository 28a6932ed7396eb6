#include "core/mean_up.h"

#include <cmath>
#include <numbers>

namespace tessera {

std::optional<Eigen::Vector3d> MeanUp(const std::vector<StampedPose>& path,
                                      const TriangleMesh& mesh) {
    constexpr double kLeast = 0.3, kMuchBetter = 1.5;
    const double near = std::cos(40 * std::numbers::pi / 180);
    Eigen::Vector3d up = Eigen::Vector3d::Zero(), left = Eigen::Vector3d::Zero();
    for (const StampedPose& pose : path) {
        left -= pose.T_world_camera.linear().col(0) / static_cast<double>(path.size());
        up -= pose.T_world_camera.linear().col(1) / static_cast<double>(path.size());
    }
    const bool sideways = left.norm() > kMuchBetter * up.norm();
    if (sideways) up = left;
    if (up.norm() < kLeast) return std::nullopt;
    up.normalize();
    if (!sideways) return up;
    // To the left or to the right: more surface is seen from above than from below.
    double facing_up = 0;
    for (const Eigen::Vector3f& normal : mesh.normals) {
        const double along = normal.cast<double>().dot(up);
        if (std::abs(along) > near) facing_up += along;
    }
    return facing_up < 0 ? Eigen::Vector3d(-up) : up;
}

}  // namespace tessera
