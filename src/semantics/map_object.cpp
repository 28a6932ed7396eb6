#include "semantics/map_object.h"

#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <unordered_map>
#include <vector>

namespace tessera {
namespace {

constexpr double kStray = 0.005;
constexpr int kAngles = 30;  // tested over a quarter turn
// Points used by these tests; the final box is fitted to all points.
constexpr std::size_t kTried = 1000;

using WorldPoints = std::vector<Eigen::Vector3d>;

Eigen::AlignedBox3d TrimmedBox(const WorldPoints& points, const Eigen::Matrix3d& R_box_world) {
    Eigen::AlignedBox3d box;
    std::vector<double> values(points.size());
    const auto low = static_cast<std::ptrdiff_t>(kStray * static_cast<double>(points.size()));
    for (int axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < points.size(); ++i)
            values[i] = R_box_world.row(axis).dot(points[i]);
        std::nth_element(values.begin(), values.begin() + low, values.end());
        box.min()[axis] = values[static_cast<std::size_t>(low)];
        std::nth_element(values.begin(), values.end() - 1 - low, values.end());
        box.max()[axis] = *(values.end() - 1 - low);
    }
    return box;
}

Eigen::Matrix3d PrincipalAxes(const WorldPoints& points) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : points) mean += p / static_cast<double>(points.size());
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& p : points) second += (p - mean) * (p - mean).transpose();
    Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(second).eigenvectors();
    if (axes.determinant() < 0) axes.col(0) *= -1;
    return axes.transpose();
}

// Tests rotations of the principal axes about each of them and keeps the smallest box.
void FitOrientedBox(const WorldPoints& points, MapObject& object) {
    const Eigen::Matrix3d principal = PrincipalAxes(points);
    WorldPoints some;
    for (std::size_t i = 0; i < points.size(); i += (points.size() + kTried - 1) / kTried)
        some.push_back(points[i]);
    double least = std::numeric_limits<double>::max();
    Eigen::Matrix3d R_best = principal;
    for (int about = 0; about < 3; ++about)
        for (int step = 0; step < kAngles; ++step) {
            const double angle = step * std::numbers::pi / 2 / kAngles;
            const Eigen::Matrix3d R =
                Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(about)).toRotationMatrix() *
                principal;
            const Eigen::AlignedBox3d box = TrimmedBox(some, R);
            const double volume = (box.sizes().array() + 1e-4).prod();
            if (volume >= least) continue;
            least = volume;
            R_best = R;
        }
    const Eigen::AlignedBox3d box = TrimmedBox(points, R_best);
    object.T_world_oriented.linear() = R_best.transpose();
    object.T_world_oriented.translation() = R_best.transpose() * box.center();
    object.oriented_size = box.sizes();
}

nlohmann::ordered_json Rounded(const Eigen::Vector3d& v) {
    const auto to_tenth_mm = [](double m) { return std::round(m * 1e4) / 1e4; };
    return {to_tenth_mm(v.x()), to_tenth_mm(v.y()), to_tenth_mm(v.z())};
}

// An object's part of a mesh, in the mesh's order.
struct ObjectSurface {
    WorldPoints points;
    std::vector<std::array<std::uint32_t, 3>> triangles;  // of the mesh's vertices
};

void MeasureSurface(const TriangleMesh& mesh, const ObjectSurface& surface, MapObject& object) {
    const WorldPoints& points = surface.points;
    object.vertices = static_cast<std::int64_t>(points.size());
    if (points.empty()) return;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero(), mean = Eigen::Vector3d::Zero();
    double area = 0;
    for (const auto& [ia, ib, ic] : surface.triangles) {
        const Eigen::Vector3d a = mesh.vertices[ia].cast<double>(),
                              b = mesh.vertices[ib].cast<double>(),
                              c = mesh.vertices[ic].cast<double>();
        const double part = (b - a).cross(c - a).norm();
        moment += part * (a + b + c) / 3;
        area += part;
    }
    for (const Eigen::Vector3d& p : points) mean += p / static_cast<double>(points.size());
    object.centroid = area > 0 ? Eigen::Vector3d(moment / area) : mean;
    object.box = TrimmedBox(points, Eigen::Matrix3d::Identity());
    FitOrientedBox(points, object);
}

}  // namespace

void MeasureObjects(const TriangleMesh& mesh, std::span<MapObject> objects) {
    std::unordered_map<int, ObjectSurface> surfaces;  // by the object's number
    for (const MapObject& object : objects) surfaces[object.id];
    const auto surface_of = [&](int number) {
        const auto found = surfaces.find(number);
        return found != surfaces.end() ? &found->second : nullptr;
    };
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
        if (ObjectSurface* surface = surface_of(mesh.labels[v].instance))
            surface->points.push_back(mesh.vertices[v].cast<double>());
    for (const auto& triangle : mesh.triangles) {
        const auto [a, b, c] = triangle;
        const int number = mesh.labels[a].instance;
        if (mesh.labels[b].instance != number || mesh.labels[c].instance != number) continue;
        if (ObjectSurface* surface = surface_of(number)) surface->triangles.push_back(triangle);
    }
    tbb::parallel_for(std::size_t{0}, objects.size(), [&](std::size_t i) {
        MeasureSurface(mesh, surfaces.at(objects[i].id), objects[i]);
    });
}

std::string ObjectsJson(const std::vector<MapObject>& objects) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const MapObject& o : objects) {
        const Eigen::Quaterniond q(o.T_world_oriented.linear());
        list.push_back(
            {{"id", o.id},
             {"class", o.class_name},
             {"class_id", o.class_id},
             {"colour", fmt::format("#{:02x}{:02x}{:02x}", o.colour.r, o.colour.g, o.colour.b)},
             {"probability", std::round(o.probability * 1e4) / 1e4},
             {"observations", o.observations},
             {"vertices", o.vertices},
             {"centroid", Rounded(o.centroid)},
             {"aabb_min", Rounded(o.box.min())},
             {"aabb_max", Rounded(o.box.max())},
             {"obb_centre", Rounded(o.T_world_oriented.translation())},
             {"obb_size", Rounded(o.oriented_size)},
             {"obb_quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}});
        if (!o.embedding.empty()) list.back()["embedding"] = o.embedding;
    }
    return list.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace tessera
