// Exact buildings made of boxes, with the path of a camera that is held upright in them.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/mesh.h"
#include "core/se3.h"

namespace tessera {

// Twelve triangles, seen from outside. Without normals.
inline void AddBox(const Eigen::Vector3d& low, const Eigen::Vector3d& high, TriangleMesh& mesh) {
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int i = 0; i < 8; ++i)
        mesh.vertices.emplace_back(static_cast<float>(i & 1 ? high.x() : low.x()),
                                   static_cast<float>(i & 2 ? high.y() : low.y()),
                                   static_cast<float>(i & 4 ? high.z() : low.z()));
    const std::array<std::uint32_t, 4> sides[] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                  {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& s : sides) {
        mesh.triangles.push_back({base + s[0], base + s[1], base + s[2]});
        mesh.triangles.push_back({base + s[0], base + s[2], base + s[3]});
    }
}

inline constexpr double kBoxHeight = 2.6;

inline void AddWall(double x0, double y0, double x1, double y1, TriangleMesh& mesh) {
    AddBox({x0, y0, 0}, {x1, y1, kBoxHeight}, mesh);
}

inline void AddFloorAndCeiling(double x0, double y0, double x1, double y1, TriangleMesh& mesh) {
    AddBox({x0, y0, -0.1}, {x1, y1, 0}, mesh);
    AddBox({x0, y0, kBoxHeight}, {x1, y1, kBoxHeight + 0.1}, mesh);
}

// 4 m x 3 m and 3 m x 3 m, between them a wall of 12 cm at x = 4 with a doorway of 90 cm, y from 1
// to 1.9, 2 m high. A table and a shelf of 1.8 m stand at the walls.
inline TriangleMesh TwoRooms() {
    TriangleMesh mesh;
    AddFloorAndCeiling(-0.2, -0.2, 7.32, 3.2, mesh);
    AddWall(-0.2, -0.2, 0, 3.2, mesh);
    AddWall(7.12, -0.2, 7.32, 3.2, mesh);
    AddWall(0, -0.2, 7.12, 0, mesh);
    AddWall(0, 3, 7.12, 3.2, mesh);
    AddWall(4, 0, 4.12, 1, mesh);
    AddWall(4, 1.9, 4.12, 3, mesh);
    AddBox({4, 1, 2}, {4.12, 1.9, kBoxHeight}, mesh);
    AddBox({1, 2.2, 0}, {2.4, 3, 0.75}, mesh);
    AddBox({6.8, 0.5, 0}, {7.12, 1.4, 1.8}, mesh);
    return mesh;
}

// 4 m x 4 m without its corner of 2.5 m x 2 m.
inline TriangleMesh LRoom() {
    TriangleMesh mesh;
    AddFloorAndCeiling(-0.2, -0.2, 4.2, 4.2, mesh);
    AddWall(-0.2, -0.2, 0, 4.2, mesh);
    AddWall(0, -0.2, 4.2, 0, mesh);
    AddWall(4, 0, 4.2, 2, mesh);
    AddWall(1.5, 2, 4.2, 2.2, mesh);
    AddWall(1.5, 2.2, 1.7, 4, mesh);
    AddWall(0, 4, 1.7, 4.2, mesh);
    return mesh;
}

// Looks along `heading_rad` (0: x) from 1.4 m above the origin, held upright.
inline std::vector<StampedPose> UprightPath(double heading_rad = std::numbers::pi / 2) {
    StampedPose pose;
    const Eigen::Vector3d z(std::cos(heading_rad), std::sin(heading_rad), 0),
        y = -Eigen::Vector3d::UnitZ();
    pose.T_world_camera.linear() << y.cross(z), y, z;
    pose.T_world_camera.translation() = Eigen::Vector3d(0, 0, 1.4);
    return {pose};
}

inline void Move(const Eigen::Isometry3d& T, TriangleMesh& mesh, std::vector<StampedPose>& path) {
    for (Eigen::Vector3f& vertex : mesh.vertices) vertex = T.cast<float>() * vertex;
    for (StampedPose& pose : path) pose.T_world_camera = T * pose.T_world_camera;
}

}  // namespace tessera
