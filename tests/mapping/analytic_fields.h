// Maps filled from formulas, so that tests know the exact result without any fusion.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

#include "mapping/block_map.h"

namespace tessera::testing_support {

// Signed distance in metres at a point in the world frame, positive outside.
using Sdf = std::function<double(const Eigen::Vector3d&)>;
// RGB in [0, 1] at a point in the world frame.
using Paint = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

inline Sdf Sphere(const Eigen::Vector3d& centre, double radius_m) {
    return [=](const Eigen::Vector3d& p) { return (p - centre).norm() - radius_m; };
}
// Positive on the side that `normal` (unit) points to.
inline Sdf Plane(const Eigen::Vector3d& normal, double offset_m) {
    return [=](const Eigen::Vector3d& p) { return normal.dot(p) - offset_m; };
}
inline Sdf Box(const Eigen::Vector3d& centre, const Eigen::Vector3d& half_m) {
    return [=](const Eigen::Vector3d& p) {
        const Eigen::Vector3d q = (p - centre).cwiseAbs() - half_m;
        return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
    };
}
// The torus axis is parallel to z and passes through `centre`.
inline Sdf Torus(const Eigen::Vector3d& centre, double ring_m, double tube_m) {
    return [=](const Eigen::Vector3d& p) {
        const Eigen::Vector3d q = p - centre;
        return std::hypot(std::hypot(q.x(), q.y()) - ring_m, q.z()) - tube_m;
    };
}
inline Sdf Union(const Sdf& a, const Sdf& b) {
    return [=](const Eigen::Vector3d& p) { return std::min(a(p), b(p)); };
}

// A hash that turns a counter into well-mixed bits: the only source of randomness in the tests.
inline std::uint32_t Mix(std::uint32_t v) {
    v = (v ^ v >> 16) * 0x7feb352du;
    v = (v ^ v >> 15) * 0x846ca68bu;
    return v ^ v >> 16;
}
inline double Uniform(std::uint32_t counter) { return Mix(counter) / 4294967296.0; }

// `distance` is in units of the truncation distance and is clamped to [-1, 1]. intensity < 0 means
// none.
inline FieldWord PackField(double distance, double intensity = -1) {
    const auto steps = static_cast<std::int32_t>(
        std::lround(std::clamp(distance, -1.0, 1.0) * static_cast<double>(kDistanceSteps)));
    const auto grey =
        intensity < 0 ? 0l : 1 + std::lround(intensity * static_cast<double>(kIntensitySteps));
    return static_cast<std::uint32_t>(steps) << 16 | static_cast<std::uint32_t>(grey);
}
inline double Luma(const Eigen::Vector3d& rgb) {
    return rgb.dot(Eigen::Vector3d(.299, .587, .114));
}
inline ColourWord PackColour(const Eigen::Vector3d& rgb, double weight = 1) {
    const double steps = static_cast<double>(kChromaSteps), y = Luma(rgb);
    const auto cb = static_cast<std::uint32_t>(std::lround(512 + steps * (rgb.z() - y) / 1.772));
    const auto cr = static_cast<std::uint32_t>(std::lround(512 + steps * (rgb.x() - y) / 1.402));
    return std::min(cb, 1023u) | std::min(cr, 1023u) << 10 |
           static_cast<std::uint32_t>(weight * kColourWeightSteps) << 20;
}

inline Eigen::Vector3i WorldVoxel(const BlockCoord& c, int offset) {
    return {c.x * 8 + offset % 8, c.y * 8 + offset / 8 % 8, c.z * 8 + offset / 64};
}

// Writes a whole block with weight 1 and marks it as changed.
inline void FillBlock(BlockMap& map, BlockId id, const Sdf& sdf, const Paint& paint,
                      std::uint32_t revision) {
    for (int offset = 0; offset < kBlockVoxels; ++offset) {
        const Eigen::Vector3d p =
            WorldVoxel(map.coord(id), offset).cast<double>() * map.config().voxel_size_m;
        map.field(id)[offset] =
            PackField(sdf(p) / map.config().truncation_m, paint ? Luma(paint(p)) : -1);
        map.weight(id)[offset] = static_cast<std::uint16_t>(kWeightSteps);
        if (paint) map.colour(id)[offset] = PackColour(paint(p));
    }
    map.MarkChanged(id, revision);
}

// Allocates and fills those blocks between `low` and `high`, both included, that the truncation
// band may touch.
inline void Fill(BlockMap& map, const Sdf& sdf, const BlockCoord& low, const BlockCoord& high,
                 const Paint& paint = nullptr, std::uint32_t revision = 1) {
    const double voxel = map.config().voxel_size_m;
    const double reach = map.config().truncation_m + 8 * voxel;
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x) {
                const Eigen::Vector3d middle = (Eigen::Vector3d(x, y, z) * 8).array() + 3.5;
                if (std::abs(sdf(middle * voxel)) > reach) continue;
                FillBlock(map, map.Allocate({x, y, z}), sdf, paint, revision);
            }
}

}  // namespace tessera::testing_support
