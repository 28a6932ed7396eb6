// What is written as binary glTF, taken apart by hand and read by TinyGLTF.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>
#ifdef TESSERA_HAVE_TINYGLTF
#include <tiny_gltf.h>
#endif

#include "io/mesh_writers.h"
#include "io/mesh_writers_fixture.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

// A glTF file, parsed by hand.
struct Glb {
    nlohmann::json json;
    std::string binary;

    template <class T>
    std::vector<T> Values(int accessor, std::size_t columns) const {
        const nlohmann::json& a = json["accessors"][static_cast<std::size_t>(accessor)];
        const nlohmann::json& view = json["bufferViews"][a["bufferView"].get<std::size_t>()];
        std::vector<T> values(a["count"].get<std::size_t>() * columns);
        EXPECT_EQ(view["byteLength"].get<std::size_t>(), values.size() * sizeof(T));
        EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
        std::memcpy(values.data(), binary.data() + view["byteOffset"].get<std::size_t>(),
                    values.size() * sizeof(T));
        return values;
    }
    int Attribute(const char* name) const {
        return json["meshes"][0]["primitives"][0]["attributes"][name].get<int>();
    }
};

Glb TakeApart(const std::string& bytes) {
    std::array<std::uint32_t, 5> head{};
    std::memcpy(head.data(), bytes.data(), sizeof(head));
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(head[1], 2u);
    EXPECT_EQ(head[2], bytes.size());
    EXPECT_EQ(head[3] % 4, 0u);
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    EXPECT_EQ(bytes.substr(24 + head[3], 4), std::string("BIN\0", 4));
    return {nlohmann::json::parse(bytes.substr(20, head[3])), bytes.substr(28 + head[3])};
}

TEST(MeshWriters, GlbHoldsTheArraysBitForBit) {
    const TriangleMesh mesh = LabelledTetrahedron();
    const TempFolder folder;
    ASSERT_TRUE(WriteGlb(folder / "a.glb", mesh).ok());
    const Glb glb = TakeApart(FileBytes(folder / "a.glb"));
    EXPECT_EQ(glb.json["buffers"][0]["byteLength"].get<std::size_t>(), glb.binary.size());
    const auto positions = glb.Values<float>(glb.Attribute("POSITION"), 3),
               normals = glb.Values<float>(glb.Attribute("NORMAL"), 3);
    const auto indices =
        glb.Values<std::uint32_t>(glb.json["meshes"][0]["primitives"][0]["indices"].get<int>(), 1);
    ASSERT_EQ(positions.size(), 12u);
    ASSERT_EQ(indices.size(), 12u);
    for (std::size_t i = 0; i < 12; ++i) {
        EXPECT_EQ(positions[i], mesh.vertices[i / 3][static_cast<int>(i % 3)]) << i;
        EXPECT_EQ(normals[i], mesh.normals[i / 3][static_cast<int>(i % 3)]) << i;
        EXPECT_EQ(indices[i], mesh.triangles[i / 3][i % 3]) << i;
    }
    const nlohmann::json& accessor =
        glb.json["accessors"][static_cast<std::size_t>(glb.Attribute("POSITION"))];
    EXPECT_EQ(accessor["min"], nlohmann::json({0.0, -2.5, -3.0}));
    EXPECT_EQ(accessor["max"], nlohmann::json({1.0, 0.0, 0.25}));
}

// The camera's up (-y) is up in a viewer. What lies in front of the camera lies in front of the
// viewer, who looks along -z.
TEST(MeshWriters, GlbStandsUpright) {
    const TempFolder folder;
    ASSERT_TRUE(WriteGlb(folder / "a.glb", LabelledTetrahedron()).ok());
    const auto q = TakeApart(FileBytes(folder / "a.glb"))
                       .json["nodes"][0]["rotation"]
                       .get<std::vector<double>>();
    const Eigen::Quaterniond R_viewer_world(q[3], q[0], q[1], q[2]);
    EXPECT_LT((R_viewer_world * Eigen::Vector3d(0, -1, 0) - Eigen::Vector3d(0, 1, 0)).norm(),
              1e-12);
    EXPECT_LT((R_viewer_world * Eigen::Vector3d(0, 0, 1) - Eigen::Vector3d(0, 0, -1)).norm(),
              1e-12);
    EXPECT_LT((R_viewer_world * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
}

// More colours than one conversion batch holds, so that every value occurs in every batch. The
// inverse follows the sRGB standard.
TEST(MeshWriters, GlbColoursAreLinearAndComeBackExactly) {
    TriangleMesh mesh;
    for (std::size_t i = 0; i < 300000; ++i) {
        mesh.vertices.push_back({static_cast<float>(i), 0, 0});
        mesh.colours.push_back({static_cast<std::uint8_t>(i % 256),
                                static_cast<std::uint8_t>((i + 1) % 256),
                                static_cast<std::uint8_t>(i / 256 % 256)});
    }
    mesh.triangles = {{0, 1, 2}};
    const TempFolder folder;
    ASSERT_TRUE(WriteGlb(folder / "a.glb", mesh).ok());
    const Glb glb = TakeApart(FileBytes(folder / "a.glb"));
    const auto colours = glb.Values<std::uint16_t>(glb.Attribute("COLOR_0"), 4);
    const auto srgb = [&](std::size_t i) {
        const double linear = colours[i] / 65535.0;
        return std::lround(255 * (linear <= 0.0031308 ? 12.92 * linear
                                                      : 1.055 * std::pow(linear, 1 / 2.4) - 0.055));
    };
    ASSERT_EQ(colours.size(), 4 * mesh.colours.size());
    for (std::size_t i = 0; i < mesh.colours.size(); ++i) {
        const Rgb8& c = mesh.colours[i];
        ASSERT_TRUE(srgb(4 * i) == c.r && srgb(4 * i + 1) == c.g && srgb(4 * i + 2) == c.b &&
                    colours[4 * i + 3] == 65535)
            << i;
    }
    EXPECT_NEAR(colours[4 * 128] / 65535.0, 0.2158605, 1e-5);  // sRGB 128
}

TEST(MeshWriters, GlbIsReadByTinyGltf) {
#ifndef TESSERA_HAVE_TINYGLTF
    GTEST_SKIP() << "needs libtinygltf-dev";
#else
    const TriangleMesh mesh = LabelledTetrahedron();
    const TempFolder folder;
    ASSERT_TRUE(WriteGlb(folder / "a.glb", mesh).ok());
    tinygltf::TinyGLTF reader;
    tinygltf::Model model;
    std::string error, warning;
    ASSERT_TRUE(reader.LoadBinaryFromFile(&model, &error, &warning, folder / "a.glb")) << error;
    EXPECT_EQ(error + warning, "");
    const tinygltf::Primitive& primitive = model.meshes.at(0).primitives.at(0);
    EXPECT_EQ(primitive.mode, TINYGLTF_MODE_TRIANGLES);
    EXPECT_EQ(
        model.accessors.at(static_cast<std::size_t>(primitive.attributes.at("COLOR_0"))).count,
        mesh.colours.size());
    const tinygltf::Accessor& indices =
        model.accessors.at(static_cast<std::size_t>(primitive.indices));
    EXPECT_EQ(indices.count, 3 * mesh.triangles.size());
    const tinygltf::BufferView& view =
        model.bufferViews.at(static_cast<std::size_t>(indices.bufferView));
    EXPECT_EQ(std::memcmp(model.buffers.at(0).data.data() + view.byteOffset, mesh.triangles.data(),
                          view.byteLength),
              0);
    EXPECT_EQ(model.materials.at(0).pbrMetallicRoughness.metallicFactor, 0);
#endif
}

TEST(MeshWriters, ATexturedGlbHasItsCoordinatesAndImage) {
    const TexturedMesh model = PaintedTetrahedron();
    const TempFolder folder;
    ASSERT_TRUE(WriteTexturedGlb(folder / "a.glb", model).ok());
    const Glb glb = TakeApart(FileBytes(folder / "a.glb"));
    const auto uv = glb.Values<float>(glb.Attribute("TEXCOORD_0"), 2);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_EQ(Eigen::Vector2f(uv[2 * i], uv[2 * i + 1]), model.uv[i]);
    EXPECT_FALSE(glb.json["meshes"][0]["primitives"][0]["attributes"].contains("COLOR_0"));
    EXPECT_EQ(glb.binary.size() % 4, 0u);
#ifdef TESSERA_HAVE_TINYGLTF
    tinygltf::TinyGLTF reader;
    tinygltf::Model read;
    std::string error, warning;
    ASSERT_TRUE(reader.LoadBinaryFromFile(&read, &error, &warning, folder / "a.glb")) << error;
    EXPECT_EQ(error + warning, "");
    EXPECT_EQ(read.materials.at(0).pbrMetallicRoughness.baseColorTexture.index, 0);
    const tinygltf::Image& image = read.images.at(0);
    ASSERT_EQ(image.width, 8);
    ASSERT_EQ(image.height, 16);
    EXPECT_NEAR(image.image.at(0), 200, 4);
    EXPECT_NEAR(image.image.at(1), 100, 4);
#endif
}

TEST(MeshWriters, AnEmptyMeshIsNoGlb) {
    const TempFolder folder;
    const Status status = WriteGlb(folder / "a.glb", {});
    EXPECT_NE(status.message().find("a.glb: the mesh is empty"), std::string::npos)
        << status.message();
    EXPECT_FALSE(std::filesystem::exists(folder / "a.glb"));
}

}  // namespace
}  // namespace tessera
