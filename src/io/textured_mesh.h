// A mesh with a texture, and its writers.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/status.h"

namespace tessera {

struct TexturedMesh {
    TriangleMesh mesh;  // with normals; colours are not written
    // One per vertex, as in glTF: (0, 0) is the top-left corner of the texture, (1, 1) the
    // bottom-right one.
    std::vector<Eigen::Vector2f> uv;
    ColourImage texture;
};

// Writes PATH.obj, and beside it PATH.mtl and PATH.png, each to a temporary file first. Metres.
// Errors name the file.
Status WriteTexturedObj(const std::string& path, const TexturedMesh& model);

// One binary glTF 2.0 file, the texture in it as JPEG (quality 95). The material is unlit
// (KHR_materials_unlit), because the texture has the light of the place in it. Axes as WriteGlb's.
Status WriteTexturedGlb(const std::string& path, const TexturedMesh& model);

}  // namespace tessera
