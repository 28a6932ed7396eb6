// Meshes and models.
#include <fmt/format.h>

#include <filesystem>

#include "core/input_file.h"
#include "fuzz/fuzz_target.h"
#include "io/mesh_io.h"
#include "synth/obj_model.h"

namespace tessera::fuzz {
namespace {

TriangleMesh SomeMesh() {
    TriangleMesh mesh;
    for (int i = 0; i < 5; ++i) {
        mesh.vertices.emplace_back(i, i * i, -i);
        mesh.normals.emplace_back(0, 0, 1);
        mesh.colours.push_back({static_cast<std::uint8_t>(i), 2, 3});
        mesh.labels.push_back({1, static_cast<std::uint16_t>(i)});
    }
    mesh.triangles = {{0, 1, 2}, {2, 3, 4}};
    return mesh;
}

std::vector<Bytes> PlySeeds() {
    const std::string path =
        std::filesystem::temp_directory_path() / fmt::format("fuzz{}.ply", getpid());
    TESSERA_CHECK(WritePly(path, SomeMesh()).ok(), "cannot write {}", path);
    const std::string binary = ReadWholeFile(path, 1 << 20).value();
    std::filesystem::remove(path);
    const std::string head =
        "ply\nformat {} 1.0\ncomment x\nelement vertex 3\nproperty float x\nproperty double y\n"
        "property uchar z\nelement face 2\nproperty list uchar int vertex_indices\n"
        "property ushort extra\nend_header\n";
    std::string ascii = head + "0 0 0\n1.5 0 0\n0 1e3 7\n3 0 1 2 9\n4 0 1 2 0 9\n";
    ascii.replace(ascii.find("{}"), 2, "ascii");
    return {BytesOf(binary), BytesOf(ascii)};
}

void ReadMesh(std::span<const std::uint8_t> bytes) {
    const BytesAsFile file(bytes);
    const Result<TriangleMesh> mesh = ReadPly(file.path());
    CheckError(mesh.status(), file.path());
    if (!mesh.ok()) return;
    for (const auto& triangle : mesh.value().triangles)
        for (const std::uint32_t corner : triangle)
            TESSERA_CHECK(corner < mesh.value().vertices.size(), "corner {}", corner);
}

void ReadModel(std::span<const std::uint8_t> bytes) {
    const BytesAsFile file(bytes);
    const Result<ObjModel> model = ReadObj(file.path());
    CheckError(model.status(), file.path());
    if (!model.ok()) return;
    const ObjModel& m = model.value();
    for (const ObjModel::Triangle& triangle : m.triangles) {
        for (const std::uint32_t corner : triangle.vertices)
            TESSERA_CHECK(corner < m.vertices.size(), "corner {}", corner);
        TESSERA_CHECK(triangle.material >= 0 && triangle.material < std::ssize(m.materials) &&
                          triangle.object >= 0 && triangle.object < std::ssize(m.object_names),
                      "material {}, object {}", triangle.material, triangle.object);
    }
}

}  // namespace

std::vector<FuzzTarget> ModelTargets() {
    return {
        {"ply", PlySeeds, ReadMesh},
        {"obj",
         [] {
             return std::vector<Bytes>{
                 BytesOf("mtllib absent.mtl\no chair\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\n"
                         "vn 0 0 1\nusemtl a\nf 1/1/1 2/1/1 3/1/1 4/1/1\ng b\nf -1 -2 -3\ns 1\n"),
                 BytesOf("v 0 0 0 1 1 1\nv 1e3 0 0\nv 0 1 0\nl 1 2\nf 1//1 2//1 3//1\n")};
         },
         ReadModel},
    };
}

}  // namespace tessera::fuzz
