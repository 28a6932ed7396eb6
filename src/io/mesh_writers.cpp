#include "io/mesh_writers.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "core/check.h"
#include "io/mesh_io.h"

namespace tessera {
namespace {

constexpr MeshFormat kFormats[] = {{".ply", WritePly}, {".obj", WriteObj}, {".glb", WriteGlb}};

}  // namespace

void CheckVertexProperties(const TriangleMesh& mesh) {
    const std::size_t count = mesh.vertices.size();
    for (const auto& [name, size] :
         {std::pair("normals", mesh.normals.size()), std::pair("colours", mesh.colours.size()),
          std::pair("labels", mesh.labels.size())})
        TESSERA_CHECK(size == 0 || size == count, "{} {}, {} vertices", size, name, count);
}

Result<MeshFormat> MeshFormatOf(const std::string& path) {
    const std::string extension = std::filesystem::path(path).extension();
    std::string known;
    for (const MeshFormat& format : kFormats) {
        if (extension == format.extension) return format;
        known += (known.empty() ? "" : ", ") + std::string(format.extension);
    }
    return Status::Error(
        fmt::format("{}: a mesh can be written as {}; use one of these extensions", path, known));
}

}  // namespace tessera
