// Small meshes with known geometry.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "core/mesh.h"

namespace tessera::testing_support {

// A grid of cells x cells squares of two triangles each, `side_m` wide, its first corner at
// `corner` and its sides along `right` and `down`; it faces down x right. Grey.
inline TriangleMesh Square(const Eigen::Vector3f& corner, const Eigen::Vector3f& right,
                           const Eigen::Vector3f& down, float side_m, std::uint32_t cells) {
    TriangleMesh mesh;
    const Eigen::Vector3f normal = down.cross(right).normalized();
    for (std::uint32_t y = 0; y <= cells; ++y)
        for (std::uint32_t x = 0; x <= cells; ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(cells),
                        v = static_cast<float>(y) / static_cast<float>(cells);
            mesh.vertices.push_back(corner + side_m * (u * right + v * down));
            mesh.normals.push_back(normal);
            mesh.colours.push_back({128, 128, 128});
        }
    for (std::uint32_t y = 0; y < cells; ++y)
        for (std::uint32_t x = 0; x < cells; ++x) {
            const std::uint32_t a = y * (cells + 1) + x, b = a + 1, c = a + cells + 1, d = c + 1;
            mesh.triangles.push_back({a, c, b});
            mesh.triangles.push_back({b, c, d});
        }
    return mesh;
}

// Welds nothing: the pieces stay apart.
inline void Append(TriangleMesh& mesh, const TriangleMesh& more) {
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
    mesh.normals.insert(mesh.normals.end(), more.normals.begin(), more.normals.end());
    mesh.colours.insert(mesh.colours.end(), more.colours.begin(), more.colours.end());
    for (auto triangle : more.triangles) {
        for (std::uint32_t& vertex : triangle) vertex += base;
        mesh.triangles.push_back(triangle);
    }
}

// A sphere about the origin, the seam and poles are welded.
inline TriangleMesh Sphere(float radius_m, std::uint32_t rings) {
    TriangleMesh mesh;
    const std::uint32_t around = 2 * rings;
    const auto add = [&](const Eigen::Vector3f& n) {
        mesh.vertices.push_back(radius_m * n);
        mesh.normals.push_back(n);
        mesh.colours.push_back({128, 128, 128});
    };
    add({0, 0, 1});
    for (std::uint32_t i = 1; i < rings; ++i)
        for (std::uint32_t k = 0; k < around; ++k) {
            const float a = 3.14159265f * static_cast<float>(i) / static_cast<float>(rings),
                        b = 6.2831853f * static_cast<float>(k) / static_cast<float>(around);
            add({std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)});
        }
    add({0, 0, -1});
    const auto at = [&](std::uint32_t i, std::uint32_t k) {
        return 1 + (i - 1) * around + k % around;
    };
    const auto last = static_cast<std::uint32_t>(mesh.vertices.size()) - 1;
    for (std::uint32_t k = 0; k < around; ++k) {
        mesh.triangles.push_back({0, at(1, k), at(1, k + 1)});
        for (std::uint32_t i = 1; i + 1 < rings; ++i) {
            mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
            mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
        }
        mesh.triangles.push_back({at(rings - 1, k), last, at(rings - 1, k + 1)});
    }
    return mesh;
}

}  // namespace tessera::testing_support
