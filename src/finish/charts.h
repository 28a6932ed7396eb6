// Cuts a mesh into charts: pieces that are flat enough to be laid into a plane, for a texture.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh.h"

namespace tessera {

// Some of a mesh's triangles, projected along one direction. The projections do not overlap (but
// for a rim of less than a cell), so a place of the chart is a place of the surface.
struct Chart {
    std::vector<std::uint32_t> triangles;
    // A point p is at ((p - origin) . right, (p - origin) . down), in metres, within
    // [0, size_m.x] x [0, size_m.y]. right x down points into the surface. Both are unit vectors,
    // or shorter in a chart that was shrunk.
    Eigen::Vector3f origin = Eigen::Vector3f::Zero();
    Eigen::Vector3f right = Eigen::Vector3f::UnitX(), down = Eigen::Vector3f::UnitY();
    Eigen::Vector2f size_m = Eigen::Vector2f::Zero();

    Eigen::Vector2f Place(const Eigen::Vector3f& p) const {
        return {(p - origin).dot(right), (p - origin).dot(down)};
    }
    // For fewer texels, `share` (at most 1) of them along each axis.
    void Shrink(float share) {
        right *= share;
        down *= share;
        size_m *= share;
    }
};

struct ChartOptions {
    // Largest angle between a triangle's normal and the mean of its chart when it joins. A texel is
    // stretched by 1.7 there; by 6.7 at most, because the mean moves as the chart grows.
    double max_angle_rad = 55 * 3.14159265358979 / 180;
    // Charts stay within a ball of this diameter about their first triangle's first corner; only
    // this triangle may be larger.
    double max_side_m = 1.5;
    double cell_m = 0.003;  // two triangles overlap where both cover the centre of a cell
};

// Grows charts from seeds over shared edges, in the order of the triangles. Each triangle is in
// exactly one chart. Deterministic; thread-safe.
std::vector<Chart> CutCharts(const TriangleMesh& mesh, const ChartOptions& options);

}  // namespace tessera
