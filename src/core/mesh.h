// An indexed triangle mesh. The mesher produces it; the writers, the renderer and the evaluation
// read it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/image.h"

namespace tessera {

// Object class and object instance that a vertex belongs to; 0 = unknown.
struct VertexLabel {
    std::uint8_t class_id = 0;
    std::uint16_t instance = 0;
    bool operator==(const VertexLabel&) const = default;
};

struct TriangleMesh {
    std::vector<Eigen::Vector3f> vertices;  // metres
    std::vector<Eigen::Vector3f> normals;   // unit, out of the surface; empty or one per vertex
    std::vector<Rgb8> colours;              // empty or one per vertex
    std::vector<VertexLabel> labels;        // empty or one per vertex
    std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
};

}  // namespace tessera
