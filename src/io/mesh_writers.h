// Mesh export for other programs: the file formats, selected by extension, and their writers. Only
// PLY files hold labels. All writers use a temporary file and rename it, so an existing file is
// never left half overwritten. docs/exports.md lists programs that open each format.
#pragma once

#include <string>

#include "core/mesh.h"
#include "core/status.h"

namespace tessera {

// Aborts if a vertex property is neither empty nor one per vertex, which all writers rely on.
void CheckVertexProperties(const TriangleMesh& mesh);

struct MeshFormat {
    const char* extension;
    Status (*write)(const std::string& path, const TriangleMesh& mesh);
};

// Returns the format for a path's extension: .ply, .obj or .glb. The error lists them.
Result<MeshFormat> MeshFormatOf(const std::string& path);

// Wavefront OBJ, text: "v x y z r g b", metres with 6 decimals in the mesh's own frame, colours as
// in the images (sRGB, 0 to 1), "vn" if the mesh has normals.
Status WriteObj(const std::string& path, const TriangleMesh& mesh);

// Binary glTF 2.0, metres. Its node rotates the world (x right, y down, z forward) by half a turn
// about x, so that viewers, which have y up, show it upright. The vertices are not changed. COLOR_0
// is linear, as the specification requires, in 16 bits, which keeps all 256 sRGB values distinct.
// Errors, besides write errors: a mesh without triangles, which the format cannot hold, and more
// than 4 GiB.
Status WriteGlb(const std::string& path, const TriangleMesh& mesh);

// Writes only the vertices, with all their properties, as a binary PLY point cloud.
Status WritePlyCloud(const std::string& path, const TriangleMesh& mesh);

}  // namespace tessera
