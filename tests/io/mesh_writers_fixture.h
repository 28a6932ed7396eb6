// A tetrahedron with colours, labels and a texture, and the bytes of the files it is written to.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include "core/input_file.h"
#include "io/mesh_io.h"
#include "io/textured_mesh.h"

namespace tessera {

inline TriangleMesh LabelledTetrahedron() {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0.25f}, {0, -2.5f, 0}, {0, 0, -3}};
    mesh.normals = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0.6f, 0, 0.8f}};
    mesh.colours = {{0, 51, 255}, {255, 128, 7}, {9, 8, 7}, {1, 1, 1}};
    mesh.labels = {{1, 2}, {0, 0}, {3, 400}, {0, 0}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    return mesh;
}

inline TexturedMesh PaintedTetrahedron() {
    TexturedMesh model;
    model.mesh = LabelledTetrahedron();
    model.uv = {{0.25f, 0.125f}, {1, 0}, {0, 1}, {0.5f, 0.5f}};
    model.texture = ColourImage(8, 16, Rgb8{200, 100, 50});
    return model;
}

inline std::string FileBytes(const std::string& path) {
    const Result<std::string> bytes = ReadWholeFile(path, std::size_t{1} << 28);
    EXPECT_TRUE(bytes.ok()) << bytes.message();
    return bytes.ok() ? bytes.value() : "";
}

}  // namespace tessera
