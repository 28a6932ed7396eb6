#include "io/mesh_writers.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "io/image_io.h"
#include "io/mesh_io.h"
#include "io/mesh_writers_fixture.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

TEST(MeshWriters, ObjIsTheTextThatReadersKnow) {
    TriangleMesh mesh = LabelledTetrahedron();
    mesh.triangles.resize(1);
    const TempFolder folder;
    ASSERT_TRUE(WriteObj(folder / "a.obj", mesh).ok());
    EXPECT_EQ(FileBytes(folder / "a.obj"),
              "# made by tessera, metres; 4 vertices, 1 triangles\n"
              "v 0.000000 0.000000 0.000000 0.0000 0.2000 1.0000\n"
              "v 1.000000 0.000000 0.250000 1.0000 0.5020 0.0275\n"
              "v 0.000000 -2.500000 0.000000 0.0353 0.0314 0.0275\n"
              "v 0.000000 0.000000 -3.000000 0.0039 0.0039 0.0039\n"
              "vn 0.0000 0.0000 1.0000\nvn 1.0000 0.0000 0.0000\nvn 0.0000 1.0000 0.0000\nvn "
              "0.6000 0.0000 0.8000\n"
              "f 1//1 3//3 2//2\n");
    mesh.colours.clear();
    mesh.normals.clear();
    ASSERT_TRUE(WriteObj(folder / "a.obj", mesh).ok());
    EXPECT_NE(FileBytes(folder / "a.obj").find("v 1.000000 0.000000 0.250000\n"),
              std::string::npos);
    EXPECT_NE(FileBytes(folder / "a.obj").find("\nf 1 3 2\n"), std::string::npos);
}

TEST(MeshWriters, ATexturedObjHasItsMaterialAndImage) {
    const TexturedMesh model = PaintedTetrahedron();
    const TempFolder folder;
    ASSERT_TRUE(WriteTexturedObj(folder / "a.obj", model).ok());
    const std::string text = FileBytes(folder / "a.obj");
    EXPECT_NE(text.find("\nmtllib a.mtl\nusemtl surface\nv 0.000000 0.000000 0.000000\n"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("\nvt 0.250000 0.875000\n"), std::string::npos) << text;  // v points up
    EXPECT_NE(text.find("\nf 1/1/1 3/3/3 2/2/2\n"), std::string::npos) << text;
    EXPECT_NE(FileBytes(folder / "a.mtl").find("map_Kd a.png\n"), std::string::npos);
    const Result<ColourImage> image = ReadColourImage(folder / "a.png");
    ASSERT_TRUE(image.ok()) << image.message();
    EXPECT_EQ(image.value(), model.texture);
}

TEST(MeshWriters, ACloudIsTheVerticesAndNothingElse) {
    const TriangleMesh mesh = LabelledTetrahedron();
    const TempFolder folder;
    ASSERT_TRUE(WritePlyCloud(folder / "a.ply", mesh).ok());
    const Result<TriangleMesh> back = ReadPly(folder / "a.ply");
    ASSERT_TRUE(back.ok()) << back.message();
    EXPECT_EQ(back.value().vertices, mesh.vertices);
    EXPECT_EQ(back.value().normals, mesh.normals);
    EXPECT_EQ(back.value().colours, mesh.colours);
    EXPECT_EQ(back.value().labels, mesh.labels);
    EXPECT_TRUE(back.value().triangles.empty());
    EXPECT_EQ(FileBytes(folder / "a.ply").find("face"), std::string::npos);
}

TEST(MeshWriters, TheExtensionChoosesAndAnUnknownOneIsRefusedByName) {
    for (const char* name : {"a.ply", "b.obj", "folder.obj/c.glb"})
        EXPECT_TRUE(MeshFormatOf(name).ok()) << name;
    EXPECT_TRUE(MeshFormatOf("a.obj").value().write == WriteObj);
    for (const char* name : {"a.stl", "a", "obj"}) {
        const Result<MeshFormat> none = MeshFormatOf(name);
        ASSERT_FALSE(none.ok()) << name;
        EXPECT_EQ(none.message(),
                  std::string(name) +
                      ": a mesh can be written as .ply, .obj, .glb; use one of these extensions");
    }
}

TEST(MeshWriters, AFullDiskIsAnError) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full (Linux)";
    for (const auto write : {WriteObj, WriteGlb, WritePlyCloud})
        EXPECT_NE(write("/dev/full", LabelledTetrahedron()).message().find("no space"),
                  std::string::npos);
}

}  // namespace
}  // namespace tessera
