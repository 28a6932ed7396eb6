#include "synth/obj_model.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "support/temp_folder.h"
#include "synth/hash_random.h"

namespace tessera {
namespace {

std::string WriteFile(const std::string& name, const std::string& text) {
    const std::string path = ProcessFolder() + "/" + name;
    std::ofstream(path, std::ios::binary) << text;
    return path;
}

const char* const kQuad =
    "o table_01\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "f 1/1 2/2 3/3 4/4\n";

TEST(ObjModel, AQuadBecomesTwoTriangles) {
    const auto model = ReadObj(WriteFile("quad.obj", kQuad));
    ASSERT_TRUE(model.ok()) << model.message();
    ASSERT_EQ(model.value().triangles.size(), 2u);
    EXPECT_EQ(model.value().triangles[1].vertices, (std::array<std::uint32_t, 3>{0, 2, 3}));
    EXPECT_EQ(model.value().triangles[1].uv[2], Eigen::Vector2f(0, 1));
    EXPECT_EQ(model.value().object_names, std::vector<std::string>{"table_01"});
}

TEST(ObjModel, MissingMaterialsAreNoError) {
    const auto model =
        ReadObj(WriteFile("bare.obj", "mtllib absent.mtl\nusemtl wood\n" + std::string(kQuad)));
    ASSERT_TRUE(model.ok()) << model.message();
    EXPECT_EQ(model.value().triangles[0].material,
              static_cast<int>(model.value().materials.size()) - 1);
}

// Each case must give a one-line error that names the file and the problem.
TEST(ObjModel, BadFilesAreRefusedInOneLine) {
    const std::pair<std::string, std::string> cases[] = {
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "refers to vertex 9, but there are only 3"},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -9\n", "bad"},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2000000000\n", "bad"},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "no triangles"},
        {"", "no triangles"},
        {"v 0 0 0\nv 1e30 0 0\nv 0 1 0\nf 1 2 3\n", "check the model's units"},
        {"v 0 0 0\nv 1 0 0\nf 1 1 2\n", "no triangles"},
    };
    int number = 0;
    for (const auto& [text, expected] : cases) {
        const std::string path = WriteFile(fmt::format("bad{}.obj", number++), text);
        const auto model = ReadObj(path);
        ASSERT_FALSE(model.ok()) << text;
        EXPECT_EQ(model.message().rfind(path + ": ", 0), 0u) << model.message();
        if (expected != "bad") {
            EXPECT_NE(model.message().find(expected), std::string::npos) << model.message();
        }
        EXPECT_EQ(model.message().find('\n'), std::string::npos) << model.message();
    }
    EXPECT_EQ(ReadObj("/nowhere/a.obj").message(),
              "/nowhere/a.obj: no such file (a Wavefront .obj model is needed)");
    EXPECT_FALSE(ReadObj(testing::TempDir()).ok());
}

TEST(ObjModel, APolygonOfMoreCornersThanTheParserCountsIsSafe) {
    std::string text, face = "f";
    for (int i = 0; i < 700; ++i) {
        text += fmt::format("v {} {} 0\n", i, i * i % 97);
        face += fmt::format(" {}", i + 1);
    }
    (void)ReadObj(WriteFile("polygon.obj", text + face + "\n"));
}

TEST(ObjModel, DamagedFilesNeverCrash) {
    const std::string whole =
        "mtllib a.mtl\n" + std::string(kQuad) + "f 1//1 2//2 3//3\nf -1 -2 -3\ns 1\ng x y\n";
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        std::string text = whole;
        for (std::uint64_t i = 0; i < 6; ++i) {
            const std::uint64_t bits = StreamKey(seed, i);
            const char pool[] = "0123456789/-.ef \nvt\xff";
            text[bits % text.size()] = pool[(bits >> 32) % (sizeof(pool) - 1)];
        }
        const auto model = ReadObj(WriteFile("damaged.obj", text));
        if (!model.ok()) continue;
        for (const auto& triangle : model.value().triangles)
            for (const auto v : triangle.vertices) ASSERT_LT(v, model.value().vertices.size());
    }
}

}  // namespace
}  // namespace tessera
