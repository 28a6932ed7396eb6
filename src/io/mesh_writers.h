// Meshes for other programs: which file formats there are, by extension, and their writers. Labels
// go into PLY files only. All are written beside the target and renamed, so that an existing file
// is never half overwritten. docs/exports.md says what opens them.
#pragma once

#include <cstddef>
#include <string>

#include "core/mesh.h"
#include "core/status.h"

namespace tessera {

// What a writer collects before it hands it on to the file.
inline constexpr std::size_t kMeshPieceBytes = std::size_t{1} << 20;

// Stops the program where a property is neither empty nor one per vertex: what every writer relies
// on.
void CheckVertexProperties(const TriangleMesh& mesh);

struct MeshFormat {
    const char* extension;
    Status (*write)(const std::string& path, const TriangleMesh& mesh);
};

// The format that a path's extension asks for: .ply, .obj or .glb. The error names those.
Result<MeshFormat> MeshFormatOf(const std::string& path);

// Wavefront OBJ, text: "v x y z r g b", metres with 6 decimals in the mesh's own frame, colours as
// the images have them (sRGB, 0 to 1), "vn" where the mesh has normals.
Status WriteObj(const std::string& path, const TriangleMesh& mesh);

// Binary glTF 2.0, metres. Its node turns the world (x right, y down, z forward) by half a turn
// about x, so that viewers, whose y is up, show it upright; the vertices stay as they are. COLOR_0
// is linear, as the specification wants it, in 16 bits: the exact image of all 256 sRGB values.
// Nothing but a megabyte of colours is copied. Errors, besides those of writing: a mesh without
// triangles, which the format cannot hold, and more than 4 GiB.
Status WriteGlb(const std::string& path, const TriangleMesh& mesh);

// The vertices alone as a binary PLY point cloud, with all that the mesh knows of them.
Status WritePlyCloud(const std::string& path, const TriangleMesh& mesh);

}  // namespace tessera
