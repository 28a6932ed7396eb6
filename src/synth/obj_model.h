// Contents of a Wavefront .obj model: triangles with texture coordinates, materials and object
// names.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/status.h"

namespace tessera {

struct ObjModel {
    struct Triangle {
        std::array<std::uint32_t, 3> vertices;
        // (0, 0) is the bottom-left corner of the image, as in the file.
        std::array<Eigen::Vector2f, 3> uv;
        int material;  // index into materials
        int object;    // index into object_names
    };
    struct Material {
        Rgb8 colour{180, 180, 180};  // used if there is no texture or its file is missing
        std::string texture_path;    // empty: no texture
    };

    std::vector<Eigen::Vector3f> vertices;  // metres
    std::vector<Triangle> triangles;
    std::vector<Material> materials;  // the last one is for faces without a material
    std::vector<std::string> object_names;
};

// Splits polygons into fans. Errors name the file and the problem: not readable, no triangles, an
// invalid index, coordinates that are not finite or beyond 100 km. A missing .mtl or texture is not
// an error. Never throws.
Result<ObjModel> ReadObj(const std::string& path);

}  // namespace tessera
