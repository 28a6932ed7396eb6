#include <fmt/compile.h>
#include <fmt/format.h>

#include <iterator>

#include "io/file.h"
#include "io/mesh_writers.h"

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
    for (const Eigen::Vector3f& n : mesh.normals)
        lines.Add(FMT_COMPILE("vn {:.4f} {:.4f} {:.4f}\n"), n.x(), n.y(), n.z());
}

// OBJ indices start at 1.
void AddFaces(const TriangleMesh& mesh, LineBuffer& lines) {
    for (const auto& [a, b, c] : mesh.triangles) {
        const std::uint64_t i = std::uint64_t{a} + 1, j = std::uint64_t{b} + 1,
                            k = std::uint64_t{c} + 1;
        if (mesh.normals.empty())
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
        AddFaces(mesh, lines);
    }
    return file.Commit();
}

}  // namespace tessera
