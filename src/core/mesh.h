// An indexed triangle mesh, as the mesher makes it and the writers, the renderer and the evaluation read it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/image.h"

namespace tessera {

struct TriangleMesh {
    std::vector<Eigen::Vector3f> vertices;  // metres
    std::vector<Eigen::Vector3f> normals;   // unit, out of the surface; empty or one per vertex
    std::vector<Rgb8> colours;              // empty or one per vertex
    std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
};

}  // namespace tessera
