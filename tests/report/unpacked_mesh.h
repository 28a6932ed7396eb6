// The viewer's decoding (src/report/page/viewer_model.js, viewer_draw.js) in C++, to test what it
// gets.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

#include "report/mesh_packing.h"

namespace tessera {

struct UnpackedVertex {
    Eigen::Vector3d position, normal;
    Rgb8 colour;
    int class_id = 0;
};

inline UnpackedVertex UnpackVertex(const PackedMesh& packed, std::size_t v) {
    const std::uint8_t* bytes = packed.vertices.data() + kPackedVertexBytes * v;
    UnpackedVertex vertex;
    for (int axis = 0; axis < 3; ++axis) {
        const int code = bytes[2 * axis] | bytes[2 * axis + 1] << 8;
        vertex.position[axis] = packed.low[axis] + packed.step[axis] * code;
    }
    const double x = static_cast<std::int8_t>(bytes[6]) / 127.0;
    const double y = static_cast<std::int8_t>(bytes[7]) / 127.0;
    Eigen::Vector3d n(x, y, 1 - std::abs(x) - std::abs(y));
    if (n.z() < 0)
        n.head<2>() = Eigen::Vector2d((1 - std::abs(y)) * (x >= 0 ? 1 : -1),
                                      (1 - std::abs(x)) * (y >= 0 ? 1 : -1));
    vertex.normal = n.normalized();
    vertex.colour = {bytes[8], bytes[9], bytes[10]};
    if (bytes[11] != 0) vertex.class_id = packed.classes.at(bytes[11] - 1u);
    return vertex;
}

inline std::vector<std::uint32_t> UnpackCorners(const PackedMesh& packed) {
    std::vector<std::uint32_t> corners;
    std::uint32_t next = 0, behind = 0;
    int shift = 0;
    for (const std::uint8_t byte : packed.corners) {
        behind |= static_cast<std::uint32_t>(byte & 127) << shift;
        shift += 7;
        if ((byte & 128) != 0) continue;
        corners.push_back(behind == 0 ? next++ : next - behind);
        behind = 0;
        shift = 0;
    }
    return corners;
}

}  // namespace tessera
