#include <bit>
#include <cstring>
#include <limits>

#include "io/file.h"
#include "io/mesh_io.h"
#include "io/mesh_writers.h"

namespace tessera {
namespace {

// Collects small values and writes them in large pieces.
class BinaryBuffer {
  public:
    explicit BinaryBuffer(AtomicFile& file) : file_(file) { bytes_.reserve(kMeshPieceBytes + 64); }
    ~BinaryBuffer() { file_.Write(bytes_); }
    BinaryBuffer(const BinaryBuffer&) = delete;
    BinaryBuffer& operator=(const BinaryBuffer&) = delete;

    template <class T>
    void Add(const T& value) {
        static_assert(std::endian::native == std::endian::little, "PLY files are little endian");
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
        if (bytes_.size() < kMeshPieceBytes) return;
        file_.Write(bytes_);
        bytes_.clear();
    }
    void AddVector(const Eigen::Vector3f& v) {
        for (const float value : {v.x(), v.y(), v.z()}) Add(value);
    }

  private:
    AtomicFile& file_;
    std::string bytes_;
};

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
    {
        BinaryBuffer buffer(file);
        for (std::size_t i = 0; i < count; ++i) {
            buffer.AddVector(mesh.vertices[i]);
            if (!mesh.normals.empty()) buffer.AddVector(mesh.normals[i]);
            if (!mesh.colours.empty()) buffer.Add(mesh.colours[i]);
            if (mesh.labels.empty()) continue;
            buffer.Add(mesh.labels[i].class_id);
            buffer.Add(mesh.labels[i].instance);
        }
        if (content == Content::kMesh)
            for (const auto& triangle : mesh.triangles) {
                buffer.Add(std::uint8_t{3});
                buffer.Add(triangle);
            }
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
