#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/quantile.h"
#include "render/mesh_picture.h"

namespace tessera {
namespace {

using Eigen::Vector3d;

constexpr double kFieldOfView_rad = 50 * std::numbers::pi / 180;
constexpr double kFilled = 0.92;    // fraction of the picture that the mesh may fill
constexpr double kOutliers = 0.01;  // fraction of the vertices that may lie outside, per side
constexpr std::size_t kMaxSamples = 50000;

// World-frame directions.
struct Outlook {
    Vector3d up, forward;
};

// The direction's horizontal part, pointed downwards by 25 to 70 degrees: steeper than `direction`.
Vector3d FromAbove(const Vector3d& direction, const Vector3d& up) {
    const Vector3d horizontal = direction - direction.dot(up) * up;
    const double looks_down_rad = std::atan2(-direction.dot(up), horizontal.norm());
    const double down_rad = std::clamp(looks_down_rad + 0.2, 0.44, 1.22);
    const Vector3d level =
        horizontal.norm() > 1e-3 * direction.norm() ? horizontal.normalized() : up.unitOrthogonal();
    return std::cos(down_rad) * level - std::sin(down_rad) * up;
}

Outlook OutlookOfPath(std::span<const Eigen::Isometry3d> path) {
    Vector3d up = Vector3d::Zero(), forward = Vector3d::Zero();
    for (const Eigen::Isometry3d& T_world_camera : path) {
        up -= T_world_camera.linear().col(1);
        forward += T_world_camera.linear().col(2);
    }
    // Cameras that looked all around have no mean direction: use the first one's.
    if (forward.norm() < 0.2 * static_cast<double>(path.size())) forward = path[0].linear().col(2);
    // Cameras that look down tilt the mean. Worlds mostly have an upright axis, so snap to it.
    up.normalize();
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(up(axis)) > 0.7) up = Vector3d::Unit(axis) * (up(axis) > 0 ? 1 : -1);
    return {up, FromAbove(forward, up)};
}

Outlook OutlookOfSurface(const TriangleMesh& mesh) {
    Vector3d mean = Vector3d::Zero();  // sum of the normals, weighted by twice the area
    double faces_up = 0;               // area facing +z minus area facing -z
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vector3d corner = mesh.vertices[a].cast<double>();
        const Vector3d normal = (mesh.vertices[b].cast<double>() - corner)
                                    .cross(mesh.vertices[c].cast<double>() - corner);
        mean += normal;
        if (std::abs(normal.z()) > 0.7 * normal.norm()) faces_up += normal.z();
    }
    const Vector3d up = faces_up > 0 ? Vector3d(Vector3d::UnitZ()) : Vector3d(-Vector3d::UnitY());
    return {up, mean.norm() > 0 ? FromAbove(-mean, up) : FromAbove(up.unitOrthogonal(), up)};
}

// Points in the camera's axes, relative to the world's origin.
struct Scene {
    std::vector<Vector3d> surface;  // a few may fall outside the picture
    std::vector<Vector3d> path;     // all must be inside
};

struct Extent {
    double low, high;
    double middle() const { return (low + high) / 2; }
};

// The extent of `value` over the scene, without the surface's outliers.
template <class Value>
Extent ExtentOf(const Scene& scene, const Value& value) {
    std::vector<double> values;
    for (const Vector3d& p : scene.surface) values.push_back(value(p));
    Extent extent{Quantile(values, kOutliers), Quantile(values, 1 - kOutliers)};
    for (const Vector3d& p : scene.path) {
        extent.low = std::min(extent.low, value(p));
        extent.high = std::max(extent.high, value(p));
    }
    return extent;
}

// The camera position from which the scene fills the picture. Refined a few times because
// perspective shifts the middle.
Vector3d FrameScene(const Scene& scene, double tan_x, double tan_y) {
    Vector3d eye;
    for (int axis = 0; axis < 3; ++axis)
        eye(axis) = ExtentOf(scene, [&](const Vector3d& p) { return p(axis); }).middle();
    const double middle_z = eye.z();
    for (int i = 0; i < 8; ++i) {
        const auto farthest_z = [&](const Vector3d& p) {
            const Vector3d away = (p - eye).cwiseAbs() / kFilled;
            return p.z() - std::max(away.x() / tan_x, away.y() / tan_y);
        };
        eye.z() = std::min(ExtentOf(scene, farthest_z).low, middle_z - 0.1);
        for (int axis = 0; axis < 2; ++axis) {
            const auto slope = [&](const Vector3d& p) {
                return (p(axis) - eye(axis)) / std::max(p.z() - eye.z(), 0.05);
            };
            eye(axis) += ExtentOf(scene, slope).middle() * (middle_z - eye.z());
        }
    }
    return eye;
}

}  // namespace

MeshView ChooseView(const TriangleMesh& mesh, std::span<const Eigen::Isometry3d> path, int width,
                    int height) {
    MeshView view;
    const double f = width / 2.0 / std::tan(kFieldOfView_rad / 2);
    view.camera = {width, height, f, f, (width - 1) / 2.0, (height - 1) / 2.0};
    if (mesh.vertices.empty()) return view;

    const Outlook outlook = path.empty() ? OutlookOfSurface(mesh) : OutlookOfPath(path);
    Eigen::Matrix3d R_world_camera;
    const Vector3d right = outlook.forward.cross(outlook.up).normalized();
    R_world_camera << right, outlook.forward.cross(right), outlook.forward;

    const Eigen::Matrix3d R_camera_world = R_world_camera.transpose();
    Scene scene;
    const std::size_t step = (mesh.vertices.size() + kMaxSamples - 1) / kMaxSamples;
    for (std::size_t i = 0; i < mesh.vertices.size(); i += step)
        scene.surface.push_back(R_camera_world * mesh.vertices[i].cast<double>());
    for (const Eigen::Isometry3d& T_world_camera : path)
        scene.path.push_back(R_camera_world * T_world_camera.translation());
    view.T_world_camera.linear() = R_world_camera;
    view.T_world_camera.translation() =
        R_world_camera * FrameScene(scene, width / 2.0 / f, height / 2.0 / f);
    return view;
}

}  // namespace tessera
