#include <fmt/compile.h>
#include <fmt/format.h>

#include <filesystem>
#include <iterator>

#include "core/check.h"
#include "io/file.h"
#include "io/image_io.h"
#include "io/mesh_writers.h"
#include "io/textured_mesh.h"

namespace tessera {
namespace {

constexpr std::size_t kLineBytes = 256;  // more than any line takes

// Collects lines and writes them in large pieces.
class LineBuffer {
  public:
    explicit LineBuffer(AtomicFile& file) : file_(file) {
        text_.reserve(kMeshPieceBytes + kLineBytes);
    }
    ~LineBuffer() { file_.Write(text_); }
    LineBuffer(const LineBuffer&) = delete;
    LineBuffer& operator=(const LineBuffer&) = delete;

    template <class Format, class... Values>
    void Add(const Format& format, const Values&... values) {
        fmt::format_to(std::back_inserter(text_), format, values...);
        if (text_.size() < kMeshPieceBytes) return;
        file_.Write(text_);
        text_.clear();
    }

  private:
    AtomicFile& file_;
    std::string text_;
};

void AddNormals(const TriangleMesh& mesh, LineBuffer& lines) {
    for (const Eigen::Vector3f& n : mesh.normals)
        lines.Add(FMT_COMPILE("vn {:.4f} {:.4f} {:.4f}\n"), n.x(), n.y(), n.z());
}

void AddVertices(const TriangleMesh& mesh, LineBuffer& lines) {
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const Eigen::Vector3f& v = mesh.vertices[i];
        if (mesh.colours.empty()) {
            lines.Add(FMT_COMPILE("v {:.6f} {:.6f} {:.6f}\n"), v.x(), v.y(), v.z());
            continue;
        }
        const Rgb8& c = mesh.colours[i];
        lines.Add(FMT_COMPILE("v {:.6f} {:.6f} {:.6f} {:.4f} {:.4f} {:.4f}\n"), v.x(), v.y(), v.z(),
                  c.r / 255.0, c.g / 255.0, c.b / 255.0);
    }
    AddNormals(mesh, lines);
}

// OBJ's (0, 0) is the bottom-left corner of the image.
void AddTextureCoordinates(const std::vector<Eigen::Vector2f>& uv, LineBuffer& lines) {
    for (const Eigen::Vector2f& at : uv)
        lines.Add(FMT_COMPILE("vt {:.6f} {:.6f}\n"), at.x(), 1 - at.y());
}

// OBJ indices start at 1. `textured`: the vertices have texture coordinates and normals.
void AddFaces(const TriangleMesh& mesh, bool textured, LineBuffer& lines) {
    for (const auto& [a, b, c] : mesh.triangles) {
        const std::uint64_t i = std::uint64_t{a} + 1, j = std::uint64_t{b} + 1,
                            k = std::uint64_t{c} + 1;
        if (textured)
            lines.Add(FMT_COMPILE("f {}/{}/{} {}/{}/{} {}/{}/{}\n"), i, i, i, j, j, j, k, k, k);
        else if (mesh.normals.empty())
            lines.Add(FMT_COMPILE("f {} {} {}\n"), i, j, k);
        else
            lines.Add(FMT_COMPILE("f {}//{} {}//{} {}//{}\n"), i, i, j, j, k, k);
    }
}

}  // namespace

Status WriteObj(const std::string& path, const TriangleMesh& mesh) {
    CheckVertexProperties(mesh);
    AtomicFile file(path);
    {
        LineBuffer lines(file);
        lines.Add(FMT_COMPILE("# made by tessera, metres; {} vertices, {} triangles\n"),
                  mesh.vertices.size(), mesh.triangles.size());
        AddVertices(mesh, lines);
        AddFaces(mesh, false, lines);
    }
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
    {
        LineBuffer lines(file);
        lines.Add(FMT_COMPILE("# made by tessera, metres; {} vertices, {} triangles\n"),
                  mesh.vertices.size(), mesh.triangles.size());
        lines.Add(FMT_COMPILE("mtllib {}.mtl\nusemtl surface\n"), name);
        for (const Eigen::Vector3f& v : mesh.vertices)
            lines.Add(FMT_COMPILE("v {:.6f} {:.6f} {:.6f}\n"), v.x(), v.y(), v.z());
        AddNormals(mesh, lines);
        AddTextureCoordinates(model.uv, lines);
        AddFaces(mesh, true, lines);
    }
    return file.Commit();
}

}  // namespace tessera
