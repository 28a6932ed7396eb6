#include "semantics/label_mapper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "mapping/analytic_fields.h"
#include "mapping/mesher.h"
#include "semantics/objects_file.h"

namespace tessera {
namespace {

const PinholeCamera kMapperCamera{
    .width = 160, .height = 120, .fx = 130, .fy = 130, .cx = 79.5, .cy = 59.5};
constexpr Rgb8 kCup{1, 200, 3}, kBook{4, 5, 220};

// A wall at 1 m that is not measured again, with detections on it.
class LabelMapperTest : public ::testing::Test {
  protected:
    LabelMapperTest() {
        config.classes = "cup=#01c803 book=#0405dc";
        map.EnableLabels();
        testing_support::Fill(map, testing_support::Plane({0, 0, -1}, -1.003), {-6, -5, 11},
                              {6, 5, 13});
        mesher.Update(map);
        mapper = std::make_unique<LabelMapper>(
            config, LabelClasses::Make(config, {"cup", "book"}).value(), kMapperCamera);
    }
    void Label(int class_id, int width) {
        Detection d;
        d.class_id = class_id;
        d.probability = 0.9f;
        d.box = {40, 30, 39.0f + static_cast<float>(width), 89};
        d.mask = Image<std::uint8_t>(width, 60, 1);
        d.embedding = {0.0f, 2.0f};
        mapper->Label({&d, 1}, depth, Eigen::Isometry3d::Identity(), map);
    }
    std::vector<Rgb8> ColoursOf(BlockId id) const {
        std::vector<Rgb8> colours;
        if (const auto& mesh = mesher.block_meshes()[static_cast<std::size_t>(id)])
            for (const auto& vertex : mesh->vertices)
                colours.push_back(mapper->ColourOf(map, *mesh, vertex));
        return colours;
    }
    // Updates the blocks listed by TakeRelabelled, and expects all others to be unchanged.
    std::size_t Renew() {
        const std::vector<BlockId> relabelled = mapper->TakeRelabelled(map);
        for (const BlockId id : relabelled)
            for (const BlockId owner : {id, map.neighbour(id, -1, 0, 0),
                                        map.neighbour(id, 0, -1, 0), map.neighbour(id, 0, 0, -1)})
                kept[owner] = ColoursOf(owner);
        for (BlockId id = 1; id < map.size(); ++id)
            if (const auto now = ColoursOf(id);
                kept.contains(id) || std::ranges::count(now, kNoSceneColour) != std::ssize(now)) {
                EXPECT_EQ(kept[id], now) << "block " << id;
            }
        return relabelled.size();
    }
    std::int64_t CountOf(const Rgb8& colour) const {
        std::int64_t n = 0;
        for (const auto& [id, colours] : kept) n += std::ranges::count(colours, colour);
        return n;
    }

    LabelConfig config;
    BlockMap map{{.voxel_size_m = 0.01, .truncation_m = 0.04}};
    Mesher mesher{{0, 0}};
    DepthImage depth{160, 120, 1.003f};
    std::unique_ptr<LabelMapper> mapper;
    std::map<BlockId, std::vector<Rgb8>> kept;
};

TEST_F(LabelMapperTest, WhatShowsDifferentlyIsNamedAlsoWhereNobodyVoted) {
    EXPECT_EQ(Renew(), 0u);
    std::size_t whole = 0;
    for (int i = 0; i < 10; ++i) {
        Label(1, 80);
        whole = Renew();
        EXPECT_EQ(CountOf(kCup) > 0, i + 1 >= config.min_observations) << i;
    }
    EXPECT_EQ(Renew(), 0u);          // no votes since
    EXPECT_GT(CountOf(kCup), 2500);  // 80 x 60 pixels of 7.7 mm
    std::size_t most = 0, least = whole;
    for (int i = 0; i < 15; ++i) {
        Label(2, 50);  // votes only for the left part
        const std::size_t named = Renew();
        most = std::max(most, named), least = std::min(least, named);
    }
    EXPECT_EQ(CountOf(kCup), 0);  // the right part belongs to the same object
    EXPECT_GT(CountOf(kBook), 2500);
    EXPECT_LT(least, whole);
    EXPECT_EQ(most, whole);  // in the frame in which it became a book
}

// An object that is in view but not detected is withheld after a while, unless its class is
// ignored.
TEST_F(LabelMapperTest, ObjectsOfAnIgnoredClassStay) {
    for (int i = 0; i < 10; ++i) Label(1, 80);
    const auto objects_after = [&](const LabelSettings& settings) {
        mapper->Apply(settings);
        for (int i = 0; i < 80; ++i) mapper->Label({}, depth, Eigen::Isometry3d::Identity(), map);
        TriangleMesh labelled = mapper->LabelledVertices(map, mesher.block_meshes());
        return mapper->Objects(0.01, labelled).size();
    };
    EXPECT_EQ(objects_after({.ignored = 1 << 1}), 1u);
    EXPECT_EQ(objects_after({}), 0u);
}

// Not before the object is confirmed. From 10 cm to the right it lies farther left in the image.
TEST_F(LabelMapperTest, PredictsTheObjectsThatACameraSees) {
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    Label(1, 80);
    const Image<VertexLabel> before = mapper->PredictLabels(T_world_camera, 2, map);
    EXPECT_EQ(std::count(before.data(), before.data() + before.size(), VertexLabel()), 160 * 120);
    for (int i = 0; i < 10; ++i) Label(1, 80);
    const auto check = [&](const Image<VertexLabel>& labels, int shift) {
        ASSERT_EQ(labels.width(), 160);
        for (const int x : {45, 75, 115})
            EXPECT_EQ(labels(x - shift, 60), (VertexLabel{1, 1})) << x;
        for (const int x : {33, 126}) EXPECT_EQ(labels(x - shift, 60), VertexLabel()) << x;
        EXPECT_EQ(labels(75 - shift, 25), VertexLabel());
    };
    check(mapper->PredictLabels(T_world_camera, 2, map), 0);
    T_world_camera.translation().x() = 0.1;
    check(mapper->PredictLabels(T_world_camera, 2, map), 13);  // 130 px * 0.1 m / 1 m
    const Image<VertexLabel> near = mapper->PredictLabels(T_world_camera, 0.9f, map);
    EXPECT_EQ(std::count(near.data(), near.data() + near.size(), VertexLabel()), 160 * 120);
}

TEST_F(LabelMapperTest, LabelledVerticesAreThoseOfTheObject) {
    for (int i = 0; i < 10; ++i) Label(1, 80);
    Renew();
    TriangleMesh labelled = mapper->LabelledVertices(map, mesher.block_meshes());
    EXPECT_EQ(std::ssize(labelled.vertices), CountOf(kCup));
    const auto objects = mapper->Objects(0.01, labelled);
    ASSERT_EQ(objects.size(), 1u);
    EXPECT_EQ(objects[0].observations, 10);
    EXPECT_EQ(objects[0].embedding, (std::vector<float>{0, 1}));
    EXPECT_EQ(objects[0].vertices, CountOf(kCup));
    // The centre of columns 40 to 119 and rows 30 to 89.
    EXPECT_NEAR(objects[0].centroid.x(), 0, 0.006);
    EXPECT_NEAR(objects[0].centroid.y(), 0, 0.006);
    EXPECT_NEAR(objects[0].centroid.z(), 1.003, 1e-4);
    mapper->Reset();
    EXPECT_TRUE(mapper->LabelledVertices(map, mesher.block_meshes()).vertices.empty());
    EXPECT_TRUE(mapper->TakeRelabelled(map).empty());
}

// Votes for other objects may leave this little of a false object.
TEST_F(LabelMapperTest, ATenthOfWhatWasSeenIsNoObject) {
    for (int i = 0; i < 10; ++i) Label(1, 80);
    const TriangleMesh whole = mapper->LabelledVertices(map, mesher.block_meshes());
    const auto objects_of = [&](double share) {
        TriangleMesh part = whole;
        const auto left =
            static_cast<std::size_t>(share * static_cast<double>(whole.vertices.size()));
        for (std::size_t i = left; i < part.labels.size(); ++i) part.labels[i] = {};
        const std::size_t objects = mapper->Objects(0.01, part).size();
        EXPECT_EQ(part.labels[0].instance != 0, objects == 1);
        return objects;
    };
    EXPECT_EQ(objects_of(0.15), 1u);
    EXPECT_EQ(objects_of(0.07), 0u);  // 200 square centimetres
}

// Vertices of a bent strip, in turn of object 3, 7, none and 9: what is measured of an object does
// not depend on the others.
TEST(MeasureObjects, EachIsMeasuredAsIfAlone) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < 400; ++i) {
        const float t = 0.01f * static_cast<float>(i);
        mesh.vertices.emplace_back(t, std::sin(3 * t), 0.2f * std::cos(7 * t));
        mesh.labels.push_back({1, std::array<std::uint16_t, 4>{3, 7, 0, 9}[i % 4]});
        if (i < 12) continue;
        mesh.triangles.push_back({i, i - 4, i - 12});
        mesh.triangles.push_back({i, i - 4, i - 7});  // belongs to two
    }
    std::vector<MapObject> objects(4);
    const std::array<int, 4> numbers{9, 3, 5, 7};  // nothing is of 5
    for (std::size_t i = 0; i < 4; ++i) objects[i].id = numbers[i];
    MeasureObjects(mesh, objects);
    for (const MapObject& object : objects) {
        TriangleMesh its = mesh;
        for (VertexLabel& label : its.labels)
            if (label.instance != object.id) label = {};
        const auto others = [&](const std::array<std::uint32_t, 3>& triangle) {
            return std::ranges::any_of(
                triangle, [&](std::uint32_t v) { return its.labels[v].instance != object.id; });
        };
        std::erase_if(its.triangles, others);
        MapObject alone;
        alone.id = object.id;
        MeasureObjects(its, {&alone, 1});
        EXPECT_EQ(object.vertices, object.id == 5 ? 0 : 100);
        EXPECT_EQ(object.vertices, alone.vertices);
        EXPECT_EQ(object.centroid, alone.centroid) << object.id;
        EXPECT_EQ(object.T_world_oriented.matrix(), alone.T_world_oriented.matrix()) << object.id;
        EXPECT_EQ(object.oriented_size, alone.oriented_size) << object.id;
        if (object.id == 5) continue;
        EXPECT_EQ(object.box.min(), alone.box.min()) << object.id;
        EXPECT_EQ(object.box.max(), alone.box.max()) << object.id;
    }
}

}  // namespace
}  // namespace tessera
