// Small meshes for tests, identical on every machine.
#pragma once

#include <cstdint>

#include "core/mesh.h"

namespace tessera {

// Numbers in [0, 1) that depend only on the seed (splitmix64).
class TestRandom {
  public:
    explicit TestRandom(std::uint64_t seed) : state_(seed) {}
    double Next() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
    }
    // A point in the cube from -half to half around the origin.
    Eigen::Vector3d Point(double half) {
        const double x = Next(), y = Next(), z = Next();
        return half * (2 * Eigen::Vector3d(x, y, z) - Eigen::Vector3d::Ones());
    }

  private:
    std::uint64_t state_;
};

// Triangles between random vertices. A few have no area.
inline TriangleMesh RandomMesh(std::uint64_t seed, int vertices, int triangles) {
    TestRandom random(seed);
    TriangleMesh mesh;
    for (int i = 0; i < vertices; ++i) mesh.vertices.push_back(random.Point(1).cast<float>());
    const auto index = [&] { return static_cast<std::uint32_t>(random.Next() * vertices); };
    for (int i = 0; i < triangles; ++i) {
        const std::uint32_t a = index(), b = index(), c = index();
        mesh.triangles.push_back({a, b, c});
    }
    return mesh;
}

// A square of side `side_m` in the plane z = z_m around the z axis, divided into cells x cells,
// with normal +z.
inline TriangleMesh Square(double side_m, int cells, double z_m) {
    TriangleMesh mesh;
    const auto row = static_cast<std::uint32_t>(cells + 1);
    for (int y = 0; y <= cells; ++y)
        for (int x = 0; x <= cells; ++x)
            mesh.vertices.push_back(Eigen::Vector3d(side_m * (double(x) / cells - 0.5),
                                                    side_m * (double(y) / cells - 0.5), z_m)
                                        .cast<float>());
    for (std::uint32_t y = 0; y + 1 < row; ++y)
        for (std::uint32_t x = 0; x + 1 < row; ++x) {
            const std::uint32_t i = y * row + x;
            mesh.triangles.push_back({i, i + 1, i + row});
            mesh.triangles.push_back({i + 1, i + row + 1, i + row});
        }
    return mesh;
}

}  // namespace tessera
