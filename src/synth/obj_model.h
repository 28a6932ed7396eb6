// A Wavefront .obj model as it is in the file: triangles with texture coordinates, materials and
// object names.
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
        std::array<Eigen::Vector2f, 3>
            uv;        // (0, 0) is the image's bottom-left corner, as in the file
        int material;  // index into materials
        int object;    // index into object_names
    };
    struct Material {
        Rgb8 colour{180, 180, 180};  // where there is no texture, or its file is missing
        std::string texture_path;    // empty: none
    };

    std::vector<Eigen::Vector3f> vertices;  // metres
    std::vector<Triangle> triangles;
    std::vector<Material> materials;  // the last one is for faces without any
    std::vector<std::string> object_names;
};

// Polygons are split as fans. Errors name the file and what is wrong: not readable, no triangles,
// an index that points nowhere, coordinates that are no numbers or beyond 100 km. A missing .mtl or
// texture is no error. Never throws.
Result<ObjModel> ReadObj(const std::string& path);

}  // namespace tessera
