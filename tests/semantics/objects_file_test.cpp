#include "semantics/objects_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "support/temp_folder.h"

namespace tessera {
namespace {

MapObject Cup() {
    MapObject o;
    o.id = 7, o.class_id = 3, o.class_name = "cup", o.colour = {177, 70, 194};
    o.probability = 0.75, o.observations = 12, o.vertices = 345;
    o.centroid = {1, 2, 3};
    o.box = Eigen::AlignedBox3d(Eigen::Vector3d(0, 1, 2), Eigen::Vector3d(2, 3, 4));
    o.T_world_oriented =
        Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
    o.oriented_size = {0.1, 0.2, 0.3};
    o.embedding = {0.6f, -0.8f};
    return o;
}

// Two triangles that share an edge. The second belongs to the cup, the first has one corner that
// does not.
TriangleMesh TwoTriangles() {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.colours.assign(4, Rgb8{100, 100, 100});
    mesh.labels = {{3, 7}, {3, 7}, {3, 7}, {0, 0}};
    mesh.triangles = {{1, 3, 2}, {0, 1, 2}};
    return mesh;
}

TEST(ObjectsFile, ReadsWhatWasWritten) {
    TempFolder folder;
    std::ofstream(folder / "objects.json") << ObjectsJson({Cup()});
    const auto read = ReadObjects(folder / "objects.json");
    ASSERT_TRUE(read.ok()) << read.message();
    ASSERT_EQ(read.value().size(), 1u);
    const MapObject &o = read.value()[0], cup = Cup();
    EXPECT_EQ(o.id, 7);
    EXPECT_EQ(o.class_id, 3);
    EXPECT_EQ(o.class_name, "cup");
    EXPECT_EQ(o.colour, cup.colour);
    EXPECT_EQ(o.observations, 12);
    EXPECT_EQ(o.vertices, 345);
    EXPECT_DOUBLE_EQ(o.probability, 0.75);
    EXPECT_TRUE(o.centroid.isApprox(cup.centroid));
    EXPECT_TRUE(o.box.isApprox(cup.box));
    EXPECT_TRUE(o.oriented_size.isApprox(cup.oriented_size));
    EXPECT_EQ(o.embedding, cup.embedding);
    EXPECT_TRUE(o.T_world_oriented.isApprox(cup.T_world_oriented, 1e-9));
}

TEST(ObjectsFile, AnEmbeddingIsThereOnlyIfTheDetectorGivesOne) {
    MapObject cup = Cup();
    EXPECT_NE(ObjectsJson({cup}).find("embedding"), std::string::npos);
    cup.embedding.clear();
    EXPECT_EQ(ObjectsJson({cup}).find("embedding"), std::string::npos);
}

TEST(ObjectsFile, WhatIsNoneIsOneLine) {
    TempFolder folder;
    for (const char* text : {"", "{}", "[{}]", "[1]", "[{\"id\": \"x\"}]"}) {
        std::ofstream(folder / "objects.json") << text;
        const auto read = ReadObjects(folder / "objects.json");
        ASSERT_FALSE(read.ok()) << text;
        EXPECT_NE(read.message().find("objects.json"), std::string::npos) << read.message();
        EXPECT_EQ(read.message().find('\n'), std::string::npos) << read.message();
    }
    EXPECT_FALSE(ReadObjects(folder / "none.json").ok());
}

TEST(ObjectsFile, CategoriesHaveTheirColoursAndTheRestIsGrey) {
    const auto colours = CategoryColours(TwoTriangles(), {Cup()});
    ASSERT_EQ(colours.size(), 4u);
    EXPECT_EQ(colours[0], Cup().colour);
    EXPECT_EQ(colours[3], (Rgb8{125, 125, 125}));  // 70 + 0.55 * 100
    EXPECT_EQ(CategoryColours(TwoTriangles(), {})[0], DistinctColour(3));
}

TEST(ObjectsFile, AnInstanceIsItsWholeTriangles) {
    const TriangleMesh part = ExtractInstance(TwoTriangles(), 7);
    ASSERT_EQ(part.triangles.size(), 1u);
    ASSERT_EQ(part.vertices.size(), 3u);
    const auto [a, b, c] = part.triangles[0];
    EXPECT_EQ(part.vertices[a], Eigen::Vector3f(0, 0, 0));
    EXPECT_EQ(part.vertices[b], Eigen::Vector3f(1, 0, 0));
    EXPECT_EQ(part.vertices[c], Eigen::Vector3f(0, 1, 0));
    EXPECT_EQ(part.colours.size(), 3u);
    EXPECT_TRUE(ExtractInstance(TwoTriangles(), 8).vertices.empty());
}

}  // namespace
}  // namespace tessera
