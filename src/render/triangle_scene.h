// A triangle mesh prepared for ray casts and nearest-point queries. Holds its own copy of the
// triangles. The only place in src/render that uses Embree.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>

#include "core/mesh.h"

namespace tessera {

struct RayHit {
    static constexpr std::uint32_t kNothing = 0xffffffffu;
    std::uint32_t triangle = kNothing;  // index, or kNothing
    float distance = 0;                 // in units of the ray direction's length
    float u = 0, v = 0;                 // the hit is (1 - u - v) a + u b + v c
    bool hit() const { return triangle != kNothing; }
};

struct SurfacePoint {
    std::uint32_t triangle = RayHit::kNothing;
    double distance_m = std::numeric_limits<double>::infinity();
    bool found() const { return triangle != RayHit::kNothing; }
};

// After construction, all queries are thread-safe.
class TriangleScene {
  public:
    // Triangle indices must lie within the vertices.
    explicit TriangleScene(const TriangleMesh& mesh);
    ~TriangleScene();
    TriangleScene(TriangleScene&&) noexcept;
    TriangleScene& operator=(TriangleScene&&) noexcept;

    // The first hits of four rays from one origin, preferably nearly parallel ones. With
    // cull_back_faces, rays pass through triangles seen from behind (clockwise).
    std::array<RayHit, 4> CastFour(const Eigen::Vector3f& origin,
                                   const std::array<Eigen::Vector3f, 4>& directions,
                                   bool cull_back_faces) const;

    // The nearest surface point at most max_distance_m away, exact in double.
    SurfacePoint Nearest(const Eigen::Vector3d& point,
                         double max_distance_m = std::numeric_limits<double>::infinity()) const;

  private:
    struct Scene;
    std::unique_ptr<Scene> scene_;
};

}  // namespace tessera
