#include "finish/nearest_depth.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

namespace tessera {

std::vector<float> NearestDepths_m(const TriangleMesh& mesh, const PinholeCamera& camera,
                                   std::span<const StampedPose> path) {
    constexpr std::size_t kMostPoses = 300;
    constexpr float kUnseen = std::numeric_limits<float>::infinity();
    std::vector<Eigen::Isometry3f> views;
    const std::size_t step = path.size() / kMostPoses + 1;
    for (std::size_t i = 0; i < path.size(); i += step)
        views.push_back(path[i].T_world_camera.inverse().cast<float>());
    const float fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy),
                cx = static_cast<float>(camera.cx), cy = static_cast<float>(camera.cy),
                right = static_cast<float>(camera.width - 1),
                bottom = static_cast<float>(camera.height - 1);
    std::vector<float> depths_m(mesh.vertices.size());
    tbb::parallel_for(std::size_t{0}, mesh.vertices.size(), [&](std::size_t v) {
        float nearest_m = kUnseen;
        for (const Eigen::Isometry3f& T_camera_world : views) {
            const Eigen::Vector3f p = T_camera_world * mesh.vertices[v];
            if (p.z() <= 0.1f || p.z() >= nearest_m) continue;
            const float u = fx * p.x() / p.z() + cx, w = fy * p.y() / p.z() + cy;
            if (u >= 0 && w >= 0 && u <= right && w <= bottom) nearest_m = p.z();
        }
        depths_m[v] = nearest_m;
    });
    float largest_m = 0.4f;
    for (const float depth_m : depths_m)
        if (depth_m != kUnseen) largest_m = std::max(largest_m, depth_m);
    std::ranges::replace(depths_m, kUnseen, largest_m);
    return depths_m;
}

}  // namespace tessera
