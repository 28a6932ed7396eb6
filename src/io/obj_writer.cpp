#include <fmt/compile.h>
#include <fmt/format.h>

#include <filesystem>

#include "core/check.h"
#include "io/file.h"
#include "io/image_io.h"
#include "io/mesh_writers.h"
#include "io/textured_mesh.h"

namespace tessera {
namespace {

void AddNormals(const TriangleMesh& mesh, AtomicFile& file) {
    for (const Eigen::Vector3f& n : mesh.normals)
        file.Write(fmt::format(FMT_COMPILE("vn {:.4f} {:.4f} {:.4f}\n"), n.x(), n.y(), n.z()));
}

void AddVertices(const TriangleMesh& mesh, AtomicFile& file) {
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const Eigen::Vector3f& v = mesh.vertices[i];
        if (mesh.colours.empty()) {
            file.Write(fmt::format(FMT_COMPILE("v {:.6f} {:.6f} {:.6f}\n"), v.x(), v.y(), v.z()));
            continue;
        }
        const Rgb8& c = mesh.colours[i];
        file.Write(fmt::format(FMT_COMPILE("v {:.6f} {:.6f} {:.6f} {:.4f} {:.4f} {:.4f}\n"), v.x(),
                               v.y(), v.z(), c.r / 255.0, c.g / 255.0, c.b / 255.0));
    }
    AddNormals(mesh, file);
}

// OBJ's (0, 0) is the bottom-left corner of the image.
void AddTextureCoordinates(const std::vector<Eigen::Vector2f>& uv, AtomicFile& file) {
    for (const Eigen::Vector2f& at : uv)
        file.Write(fmt::format(FMT_COMPILE("vt {:.6f} {:.6f}\n"), at.x(), 1 - at.y()));
}

// OBJ indices start at 1. `textured`: the vertices have texture coordinates and normals.
void AddFaces(const TriangleMesh& mesh, bool textured, AtomicFile& file) {
    for (const auto& [a, b, c] : mesh.triangles) {
        const std::uint64_t i = std::uint64_t{a} + 1, j = std::uint64_t{b} + 1,
                            k = std::uint64_t{c} + 1;
        if (textured)
            file.Write(fmt::format(FMT_COMPILE("f {}/{}/{} {}/{}/{} {}/{}/{}\n"), i, i, i, j, j, j,
                                   k, k, k));
        else if (mesh.normals.empty())
            file.Write(fmt::format(FMT_COMPILE("f {} {} {}\n"), i, j, k));
        else
            file.Write(fmt::format(FMT_COMPILE("f {}//{} {}//{} {}//{}\n"), i, i, j, j, k, k));
    }
}

}  // namespace

Status WriteObj(const std::string& path, const TriangleMesh& mesh) {
    CheckVertexProperties(mesh);
    AtomicFile file(path);
    file.Write(fmt::format(FMT_COMPILE("# made by tessera, metres; {} vertices, {} triangles\n"),
                           mesh.vertices.size(), mesh.triangles.size()));
    AddVertices(mesh, file);
    AddFaces(mesh, false, file);
    return file.Commit();
}

Status WriteTexturedObj(const std::string& path, const TexturedMesh& model) {
    const TriangleMesh& mesh = model.mesh;
    TESSERA_CHECK(model.uv.size() == mesh.vertices.size() && mesh.normals.size() == model.uv.size(),
                  "{}, {}, {}", model.uv.size(), mesh.vertices.size(), mesh.normals.size());
    const std::filesystem::path stem = std::filesystem::path(path).replace_extension();
    const std::string name = stem.filename().string();
    if (Status status = WriteColourImage(stem.string() + ".png", model.texture); !status.ok())
        return status;
    if (Status status = WriteTextFile(
            stem.string() + ".mtl",
            fmt::format("newmtl surface\nKd 1 1 1\nKa 0 0 0\nillum 0\nmap_Kd {}.png\n", name));
        !status.ok())
        return status;
    AtomicFile file(path);
    file.Write(fmt::format(FMT_COMPILE("# made by tessera, metres; {} vertices, {} triangles\n"),
                           mesh.vertices.size(), mesh.triangles.size()));
    file.Write(fmt::format(FMT_COMPILE("mtllib {}.mtl\nusemtl surface\n"), name));
    for (const Eigen::Vector3f& v : mesh.vertices)
        file.Write(fmt::format(FMT_COMPILE("v {:.6f} {:.6f} {:.6f}\n"), v.x(), v.y(), v.z()));
    AddNormals(mesh, file);
    AddTextureCoordinates(model.uv, file);
    AddFaces(mesh, true, file);
    return file.Commit();
}

}  // namespace tessera
