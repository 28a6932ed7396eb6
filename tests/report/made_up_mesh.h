// A bumpy sheet with colours and labels.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/mesh.h"

namespace tessera {

// 2 n^2 triangles over 4 x 4 m, facing up (+z). Vertices in rows; normals if asked for.
inline TriangleMesh BumpySheet(int n, bool with_normals = false) {
    TriangleMesh mesh;
    const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
    for (int y = 0; y <= n; ++y)
        for (int x = 0; x <= n; ++x) {
            const double u = 4.0 * x / n, v = 4.0 * y / n;
            mesh.vertices.push_back(
                Eigen::Vector3d(u - 1, v + 3, 0.3 * std::sin(2 * u) * std::cos(3 * v))
                    .cast<float>());
            mesh.colours.push_back({static_cast<std::uint8_t>(x * 255 / n),
                                    static_cast<std::uint8_t>(y * 255 / n), 77});
            mesh.labels.push_back(2 * x < n ? VertexLabel{} : VertexLabel{7, 3});
            if (with_normals)
                mesh.normals.push_back(Eigen::Vector3d(-0.6 * std::cos(2 * u) * std::cos(3 * v),
                                                       0.9 * std::sin(2 * u) * std::sin(3 * v), 1)
                                           .normalized()
                                           .cast<float>());
        }
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x, y + 1)});
            mesh.triangles.push_back({at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
        }
    return mesh;
}

}  // namespace tessera
