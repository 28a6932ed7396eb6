#include "finish/patch.h"

#include <numbers>

namespace tessera {
namespace {

// All normals are less than a right angle from all rays to the patch.
bool FacesAway(const TextureView& view, const Patch& patch) {
    const Eigen::Vector3f ray = patch.centre - view.centre_world;
    const float distance_m = ray.norm();
    if (distance_m <= patch.radius_m) return false;
    const float angle_rad = std::acos(std::clamp(ray.dot(patch.axis) / distance_m, -1.0f, 1.0f));
    return angle_rad + patch.spread_rad + std::asin(patch.radius_m / distance_m) <
           std::numbers::pi_v<float> / 2;
}

}  // namespace

bool MayShow(const TextureView& view, const Patch& patch) {
    const Eigen::Vector3f centre = view.T_camera_world * patch.centre;
    if (centre.z() < -patch.radius_m || centre.z() - patch.radius_m > view.farthest_m) return false;
    // Planes through the centre of projection and the image's sides.
    const auto beyond = [&](float from, float focal, float at, float sign) {
        const Eigen::Vector2f inward = Eigen::Vector2f(sign * focal, -sign * from).normalized();
        return inward.x() * at + inward.y() * centre.z() < -patch.radius_m;
    };
    const float right = static_cast<float>(view.camera.width - 1) - view.cx,
                bottom = static_cast<float>(view.camera.height - 1) - view.cy;
    return !beyond(-view.cx, view.fx, centre.x(), 1) && !beyond(right, view.fx, centre.x(), -1) &&
           !beyond(-view.cy, view.fy, centre.y(), 1) && !beyond(bottom, view.fy, centre.y(), -1) &&
           !FacesAway(view, patch);
}

}  // namespace tessera
