#include "export/level.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "core/mean_up.h"

namespace tessera {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::size_t kFewest = 2000;  // vertices of a surface; 0.2 square metres at 1 cm voxels

// The direction, within 40 degrees of `about`, to which most normals point, or from which.
Eigen::Vector3d MostNormals(const TriangleMesh& mesh, const Eigen::Vector3d& about) {
    constexpr double kFar = 40 * kDegree, kCell = 2 * kDegree;
    const Eigen::Vector3d x = about.unitOrthogonal(), y = about.cross(x);
    std::map<std::pair<int, int>, int> votes;
    for (const Eigen::Vector3f& normal : mesh.normals) {
        Eigen::Vector3d n = normal.cast<double>();
        if (n.dot(about) < 0) n = -n;
        if (n.dot(about) < std::cos(kFar)) continue;
        const int u = static_cast<int>(
                      std::floor(std::asin(std::clamp(n.dot(x), -1.0, 1.0)) / kCell)),
                  v = static_cast<int>(
                      std::floor(std::asin(std::clamp(n.dot(y), -1.0, 1.0)) / kCell));
        for (int du = -1; du <= 1; ++du)
            for (int dv = -1; dv <= 1; ++dv) ++votes[{u + du, v + dv}];
    }
    Eigen::Vector3d up = about;
    int most = 0;
    for (const auto& [cell, count] : votes) {
        if (count <= most) continue;
        most = count;
        const double a = std::sin((cell.first + 0.5) * kCell),
                     b = std::sin((cell.second + 0.5) * kCell);
        up = (a * x + b * y + std::sqrt(std::max(0.0, 1 - a * a - b * b)) * about).normalized();
    }
    for (const double cone : {8 * kDegree, 5 * kDegree, 5 * kDegree}) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (const Eigen::Vector3f& normal : mesh.normals) {
            const Eigen::Vector3d n = normal.cast<double>();
            if (std::abs(n.dot(up)) > std::cos(cone)) sum += n.dot(up) < 0 ? -n : n;
        }
        if (sum.norm() > 0) up = sum.normalized();
    }
    return up;
}

// Vertices with a normal along `up`, by height in steps of 2 cm. `facing_down`: also those with a
// normal against it.
std::map<int, std::size_t> Layers(const TriangleMesh& mesh, const Eigen::Vector3d& up,
                                  bool facing_down) {
    constexpr double kAlong = 15 * kDegree, kStep_m = 0.02;
    std::map<int, std::size_t> layers;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const double along = mesh.normals[i].cast<double>().dot(up);
        if ((facing_down ? std::abs(along) : along) < std::cos(kAlong)) continue;
        const double height_m = mesh.vertices[i].cast<double>().dot(up);
        ++layers[static_cast<int>(std::floor(height_m / kStep_m))];
    }
    return layers;
}

struct Plane {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // as `up`
    double height_m = 0;                                // along the normal
    double rms_m = 0;
    std::size_t points = 0;
};

// Least squares through the vertices near a horizontal plane.
Plane Fit(const TriangleMesh& mesh, Plane plane) {
    constexpr double kAlong = 15 * kDegree;
    for (const double near_m : {0.05, 0.03, 0.03}) {
        Eigen::Vector3d mean = Eigen::Vector3d::Zero();
        Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
        plane.points = 0;
        for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
            const Eigen::Vector3d p = mesh.vertices[i].cast<double>();
            if (std::abs(p.dot(plane.normal) - plane.height_m) > near_m ||
                std::abs(mesh.normals[i].cast<double>().dot(plane.normal)) < std::cos(kAlong))
                continue;
            mean += p;
            squares += p * p.transpose();
            ++plane.points;
        }
        if (plane.points < kFewest) return plane;
        const auto count = static_cast<double>(plane.points);
        mean /= count;
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(squares / count -
                                                                  mean * mean.transpose());
        const Eigen::Vector3d normal = axes.eigenvectors().col(0);
        plane.normal = normal.dot(plane.normal) < 0 ? Eigen::Vector3d(-normal) : normal;
        plane.height_m = mean.dot(plane.normal);
        plane.rms_m = std::sqrt(std::max(0.0, axes.eigenvalues()(0)));
    }
    return plane;
}

double HeightOf(int layer) { return 0.02 * (layer + 0.5); }

}  // namespace

Result<Level> FindLevel(const TriangleMesh& mesh, const std::vector<StampedPose>& path) {
    constexpr double kFloorShare = 0.2;
    const std::optional<Eigen::Vector3d> about = MeanUp(path, mesh);
    if (!about)
        return Status::Error(
            "the path does not show which way is up; the camera was turned in every direction");
    if (mesh.normals.size() != mesh.vertices.size())
        return Status::Error("the mesh has no normals, from which the floor is found");
    const Eigen::Vector3d up = MostNormals(mesh, *about);
    const auto size = [](const auto& layer) { return layer.second; };
    const std::map<int, std::size_t> both = Layers(mesh, up, true);
    const auto largest = std::ranges::max_element(both, {}, size);
    Plane plane{up, largest == both.end() ? 0 : HeightOf(largest->first), 0, 0};
    plane = Fit(mesh, plane);
    if (plane.points < kFewest)
        return Status::Error("no horizontal surface was found, neither a floor nor a table");
    const std::map<int, std::size_t> facing_up = Layers(mesh, plane.normal, false);
    Plane under = plane;
    if (const auto most = std::ranges::max_element(facing_up, {}, size); most != facing_up.end()) {
        const auto floor = std::ranges::find_if(facing_up, [&](const auto& layer) {
            return static_cast<double>(layer.second) >=
                   kFloorShare * static_cast<double>(most->second);
        });
        under = Fit(mesh, {plane.normal, HeightOf(floor->first), 0, 0});
    }
    const Eigen::Isometry3d& first = path.front().T_world_camera;
    const Eigen::Vector3d z = plane.normal;
    // A camera that looks straight down or up has no heading: then that of its up (or down) is
    // taken, which was ahead before the camera was turned down (or up).
    Eigen::Vector3d ahead = first.linear().col(2);
    if (std::abs(ahead.dot(z)) > std::cos(10 * kDegree))
        ahead = (ahead.dot(z) > 0 ? 1 : -1) * first.linear().col(1);
    const Eigen::Vector3d y = (ahead - ahead.dot(z) * z).normalized();
    Level level;
    Eigen::Matrix3d R_level_world;
    R_level_world << y.cross(z).transpose(), y.transpose(), z.transpose();
    level.T_level_world.linear() = R_level_world;
    // Down to the floor, whose normal is not quite z.
    const Eigen::Vector3d eye = first.translation();
    const double down_m = (eye.dot(under.normal) - under.height_m) / z.dot(under.normal);
    level.T_level_world.translation() = -(R_level_world * (eye - down_m * z));
    level.tilt_rad = std::acos(std::clamp(-first.linear().col(1).dot(z), -1.0, 1.0));
    level.points = plane.points;
    level.roughness_m = plane.rms_m;
    return level;
}

void MakeLevel(const Level& level, TriangleMesh& mesh, std::vector<StampedPose>& path) {
    const Eigen::Isometry3f T = level.T_level_world.cast<float>();
    for (Eigen::Vector3f& vertex : mesh.vertices) vertex = T * vertex;
    for (Eigen::Vector3f& normal : mesh.normals) normal = T.linear() * normal;
    for (StampedPose& pose : path)
        pose.T_world_camera = Normalised(level.T_level_world * pose.T_world_camera);
}

TriangleMesh WithYDown(TriangleMesh mesh) {
    for (auto* vectors : {&mesh.vertices, &mesh.normals})
        for (Eigen::Vector3f& v : *vectors) v = Eigen::Vector3f(v.x(), -v.z(), v.y());
    return mesh;
}

}  // namespace tessera
