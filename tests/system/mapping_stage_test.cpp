#include "system/mapping_stage.h"

#include <gtest/gtest.h>

#include "mapping/analytic_fields.h"
#include "optimize/map_warp.h"
#include "system/room_frames.h"

namespace tessera {
namespace {

const PinholeCamera kCamera{
    .width = 160, .height = 120, .fx = 130, .fy = 130, .cx = 79.5, .cy = 59.5};

Detection Seen(int class_id, float left) {
    Detection d;
    d.class_id = class_id;
    d.probability = 0.9f;
    d.box = {left, 30, left + 39, 89};
    d.mask = Image<std::uint8_t>(40, 60, 1);
    return d;
}

std::unique_ptr<BlockMap> Wall() {
    auto map =
        std::make_unique<BlockMap>(BlockMap::Config{.voxel_size_m = 0.01, .truncation_m = 0.04});
    map->EnableLabels();
    testing_support::Fill(*map, testing_support::Plane({0, 0, -1}, -1.003), {-8, -5, 11},
                          {8, 5, 13});
    return map;
}

// Object numbers by class name.
std::map<std::string, int> Numbers(MappingStage& mapping) {
    MeshUpdate update;
    mapping.UpdateMesh(Mesher::kNoLimit, update);
    std::map<std::string, int> numbers;
    for (const MapObject& object : mapping.MeasureObjects()) numbers[object.class_name] = object.id;
    return numbers;
}

TEST(MappingStage, RefusedBlocksAreToldBesideWhatElseWasTold) {
    PipelineConfig pipeline = SmallConfig();
    pipeline.fusion.max_new_blocks = 10;
    MappingStage mapping(pipeline, {0, 0}, testing_support::SmallCamera());
    TrackedFrame tracked;
    PrepareFrame(RoomFrame(0), pipeline.frame, tracked.prepared);
    tracked.report.warning = "relocalised";
    tracked.to_fuse = true;
    mapping.Fuse(tracked);
    ASSERT_GT(tracked.report.fusion.refused_blocks, 0);
    EXPECT_TRUE(tracked.report.warning.starts_with("relocalised; ")) << tracked.report.warning;
    EXPECT_TRUE(tracked.report.warning.ends_with("new blocks refused: mapping.max_new_blocks"));
}

// The window waits for this before it shows another map.
TEST(MappingStage, TellsWhenAllOfAMapWasMeshed) {
    PipelineConfig pipeline;
    pipeline.map = {.voxel_size_m = 0.01, .truncation_m = 0.04};
    MappingStage mapping(pipeline, {0, 0}, kCamera);
    std::unique_ptr<BlockMap> map = Wall();
    BlockMap& changing = *map;
    mapping.Resume(std::move(map), 0);
    MeshUpdate update;
    int updates = 0, waiting = 1;
    for (; waiting > 0; ++updates) {
        waiting = mapping.UpdateMesh(100, update);
        EXPECT_EQ(update.clear, updates == 0);
        EXPECT_EQ(update.whole, waiting == 0);
    }
    EXPECT_GE(updates, 4);
    // What changes later is new in the same map.
    for (BlockId id = 1; id < changing.size(); ++id) changing.MarkChanged(id, 100);
    EXPECT_GT(mapping.UpdateMesh(100, update), 0);
    EXPECT_TRUE(update.whole && !update.clear);
    // A map that is as large again, after it was whole.
    mapping.Resume(Wall(), 1);
    mapping.UpdateMesh(100, update);
    EXPECT_TRUE(update.clear);
    EXPECT_FALSE(update.whole);
    mapping.Reset();
    mapping.UpdateMesh(100, update);
    EXPECT_TRUE(update.clear && update.whole);
}

// The corrected map receives the objects in a different order.
TEST(MappingStage, ObjectsKeepTheirNumbersInACorrectedMap) {
    LabelConfig config;
    config.classes = "cup book";
    const LabelClasses classes = LabelClasses::Make(config, {"cup", "book"}).value();
    const DepthImage depth(160, 120, 1.003f);
    const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    const Detection cup = Seen(1, 20), book = Seen(2, 100);
    PipelineConfig pipeline;
    pipeline.map = {.voxel_size_m = 0.01, .truncation_m = 0.04};
    MappingStage mapping(pipeline, {0, 0}, kCamera);
    mapping.EnableLabels(config, classes);
    mapping.Replace(Wall(), std::make_unique<LabelMapper>(config, classes, kCamera));
    for (int i = 0; i < 10; ++i) mapping.Label({&cup, 1}, depth, pose);
    for (int i = 0; i < 10; ++i) mapping.Label({&book, 1}, depth, pose);
    const std::map<std::string, int> before = Numbers(mapping);
    ASSERT_EQ(before, (std::map<std::string, int>{{"cup", 1}, {"book", 2}}));

    auto labels = std::make_unique<LabelMapper>(config, classes, kCamera);
    std::unique_ptr<BlockMap> corrected = Wall();
    for (const Detection& d : {book, cup})
        for (int i = 0; i < 10; ++i) labels->Label({&d, 1}, depth, pose, *corrected);
    mapping.Replace(std::move(corrected), std::move(labels));
    EXPECT_EQ(Numbers(mapping), before);
}

// Nobody votes again: the labels move with the surface.
TEST(MappingStage, ObjectsMoveWithTheMap) {
    LabelConfig config;
    config.classes = "cup";
    const LabelClasses classes = LabelClasses::Make(config, {"cup"}).value();
    const DepthImage depth(160, 120, 1.003f);
    const Detection cup = Seen(1, 20);
    PipelineConfig pipeline;
    pipeline.map = {.voxel_size_m = 0.01, .truncation_m = 0.04};
    MappingStage mapping(pipeline, {0, 0}, kCamera);
    mapping.EnableLabels(config, classes);
    mapping.Replace(Wall(), std::make_unique<LabelMapper>(config, classes, kCamera));
    for (int i = 0; i < 10; ++i) mapping.Label({&cup, 1}, depth, Eigen::Isometry3d::Identity());
    MeshUpdate update;
    mapping.UpdateMesh(Mesher::kNoLimit, update);
    const std::vector<MapObject> before = mapping.MeasureObjects();
    ASSERT_EQ(before.size(), 1u);

    const Eigen::Vector3f shift_m(0.104f, -0.03f, 0.007f);
    const std::vector<BlockMotion> motions(static_cast<std::size_t>(mapping.map().size()),
                                           {shift_m, 0, true});
    MapWarp warp(mapping.map(), motions, WorldBox{}, 0.01);
    while (!warp.Step()) continue;
    mapping.Replace(warp.Take().map, nullptr);
    mapping.UpdateMesh(Mesher::kNoLimit, update);
    const std::vector<MapObject> after = mapping.MeasureObjects();
    ASSERT_EQ(after.size(), 1u);
    EXPECT_EQ(after[0].id, before[0].id);
    EXPECT_EQ(after[0].observations, 10);
    // A voxel has the label of the nearest one: at most half a voxel off.
    EXPECT_LT((after[0].centroid - before[0].centroid - shift_m.cast<double>()).norm(), 0.005);
}

}  // namespace
}  // namespace tessera
