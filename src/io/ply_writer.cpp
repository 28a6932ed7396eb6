#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include "io/file.h"
#include "io/mesh_io.h"
#include "io/mesh_writers.h"

namespace tessera {
namespace {

template <class T>
void AddPly(const T& value, AtomicFile& file) {
    static_assert(std::endian::native == std::endian::little, "PLY files are little endian");
    file.Write({reinterpret_cast<const char*>(&value), sizeof(T)});
}

void AddPlyVector(const Eigen::Vector3f& v, AtomicFile& file) {
    AddPly(std::array{v.x(), v.y(), v.z()}, file);
}

enum class Content { kMesh, kPoints };

std::string Header(const TriangleMesh& mesh, Content content) {
    std::string text = "ply\nformat binary_little_endian 1.0\ncomment made by tessera, metres\n";
    text += fmt::format("element vertex {}\n", mesh.vertices.size());
    text += "property float x\nproperty float y\nproperty float z\n";
    if (!mesh.normals.empty()) text += "property float nx\nproperty float ny\nproperty float nz\n";
    if (!mesh.colours.empty())
        text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    if (!mesh.labels.empty()) text += "property uchar class\nproperty ushort instance\n";
    if (content == Content::kMesh)
        text += fmt::format("element face {}\nproperty list uchar int vertex_indices\n",
                            mesh.triangles.size());
    return text + "end_header\n";
}

Status WriteVertices(const std::string& path, const TriangleMesh& mesh, Content content) {
    const std::size_t count = mesh.vertices.size();
    CheckVertexProperties(mesh);
    if (count > std::numeric_limits<std::int32_t>::max())
        return Status::Error(path + ": a PLY file holds at most 2^31 vertices");
    AtomicFile file(path);
    file.Write(Header(mesh, content));
    for (std::size_t i = 0; i < count; ++i) {
        AddPlyVector(mesh.vertices[i], file);
        if (!mesh.normals.empty()) AddPlyVector(mesh.normals[i], file);
        if (!mesh.colours.empty()) AddPly(mesh.colours[i], file);
        if (mesh.labels.empty()) continue;
        AddPly(mesh.labels[i].class_id, file);
        AddPly(mesh.labels[i].instance, file);
    }
    if (content == Content::kMesh)
        for (const auto& triangle : mesh.triangles) {
            AddPly(std::uint8_t{3}, file);
            AddPly(triangle, file);
        }
    return file.Commit();
}

}  // namespace

Status WritePly(const std::string& path, const TriangleMesh& mesh) {
    return WriteVertices(path, mesh, Content::kMesh);
}

Status WritePlyCloud(const std::string& path, const TriangleMesh& mesh) {
    return WriteVertices(path, mesh, Content::kPoints);
}

}  // namespace tessera
