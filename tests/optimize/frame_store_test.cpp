#include "optimize/frame_store.h"

#include <gtest/gtest.h>

#include "optimize/map_rebuild.h"
#include "support/box_room.h"

namespace tessera {
namespace {

using testing_support::BoxRoom;
using testing_support::SmallCamera;
using testing_support::SmoothPath;

Frame FrameAt(int i, bool colour = true) {
    Frame frame = BoxRoom().Render(SmallCamera(), SmoothPath(i), i / 30.0);
    frame.index = i;
    for (std::size_t p = 0; p < frame.depth_m.size(); ++p)
        frame.depth_m.data()[p] = std::round(frame.depth_m.data()[p] * 5000) / 5000;
    if (!colour) frame.colour = {};
    return frame;
}

TEST(FrameStore, GivesDepthBackExactlyAndColourNearly) {
    FrameStore store(100000000, 5000);
    Frame frame = FrameAt(0);
    frame.depth_m(3, 4) = 0;
    Integrator::View view;
    view.gain = 1.25f;
    ASSERT_TRUE(store.Add(frame, 2, true, Eigen::Isometry3d::Identity(), view).ok());
    ASSERT_EQ(store.frames().size(), 1u);
    EXPECT_EQ(store.frames()[0].keyframe, 2);
    EXPECT_EQ(store.frames()[0].view.gain, 1.25f);
    Frame back;
    ASSERT_TRUE(store.Load(store.frames()[0], back).ok());
    for (std::size_t i = 0; i < frame.depth_m.size(); ++i)
        ASSERT_NEAR(back.depth_m.data()[i], frame.depth_m.data()[i], 1e-6);
    double off = 0;
    for (std::size_t i = 0; i < frame.colour.size(); ++i)
        off += std::abs(back.colour.data()[i].g - frame.colour.data()[i].g);
    EXPECT_LT(off / static_cast<double>(frame.colour.size()), 2.0);
}

TEST(FrameStore, ColourThatWasNotFusedIsNotKept) {
    FrameStore store(100000000, 5000);
    Integrator::View view;
    view.colour_weight = 0;
    ASSERT_TRUE(store.Add(FrameAt(0), 0, true, Eigen::Isometry3d::Identity(), view).ok());
    Frame back = FrameAt(1);
    ASSERT_TRUE(store.Load(store.frames()[0], back).ok());
    EXPECT_TRUE(back.colour.empty());
    EXPECT_FALSE(back.depth_m.empty());
}

TEST(FrameStore, OverItsLimitKeepsKeyframesAndAnEvenShareOfTheRest) {
    const auto in_memory = [] { return ImageScratch("/absent"); };
    FrameStore unlimited(100000000, 5000, in_memory());
    for (int i = 0; i < 8; ++i)
        ASSERT_TRUE(unlimited.Add(FrameAt(i), 0, i == 0, Eigen::Isometry3d::Identity(), {}).ok());
    FrameStore store(unlimited.memory_bytes() / 2, 5000, in_memory());
    for (int i = 0; i < 32; ++i)
        ASSERT_TRUE(
            store.Add(FrameAt(i), 0, i == 0 || i == 5, Eigen::Isometry3d::Identity(), {}).ok());
    EXPECT_LE(store.memory_bytes(), unlimited.memory_bytes() / 2);
    EXPECT_GT(store.stride(), 4);
    EXPECT_EQ(store.next_ordinal(), 32);
    std::vector<std::int64_t> ordinals;
    for (const StoredFrame& f : store.frames()) ordinals.push_back(f.ordinal);
    EXPECT_EQ(std::ranges::count(ordinals, 5), 1);
    for (const std::int64_t o : ordinals) EXPECT_TRUE(o == 5 || o % store.stride() == 0) << o;
}

Detection MaskedDetection() {
    Detection cup{"cup", 1, 0.9f, {10, 10, 109, 90}, Image<std::uint8_t>(100, 81, 0)};
    for (int y = 0; y < 81; ++y)
        for (int x = 0; x < 100; ++x) cup.mask(x, y) = (7 * x + 3 * y) % 5 < 2;
    cup.embedding = {0.5f, -1, 2};
    return cup;
}

// 8100 pixels are 1013 bytes.
TEST(FrameStore, MasksCountAndTakeOneBitAPixel) {
    FrameStore store(100000000, 5000);
    ASSERT_TRUE(store.Add(FrameAt(0), 0, true, Eigen::Isometry3d::Identity(), {}).ok());
    const std::size_t before = store.memory_bytes();
    const Detection cup = MaskedDetection();
    store.AddDetections(0, {cup, {"book", 2, 0.8f, {1, 2, 3, 4}, {}}}, ClassSet().set(3));
    EXPECT_GE(store.memory_bytes() - before, 1013 + 3 * sizeof(float));
    EXPECT_LT(store.memory_bytes() - before, 2000u);
    EXPECT_TRUE(store.frames()[0].detections->ignored()[3]);
    const std::vector<Detection> back = store.frames()[0].detections->Unpack();
    ASSERT_EQ(back.size(), 2u);
    EXPECT_EQ(back[0].name, "cup");
    EXPECT_EQ(back[0].box, cup.box);
    EXPECT_TRUE(back[0].mask == cup.mask);
    EXPECT_EQ(back[0].embedding, cup.embedding);
    EXPECT_TRUE(back[1].mask.empty());
}

TEST(FrameStore, DetectionsOverTheLimitThinTheFrames) {
    const auto fill = [](FrameStore& store) {
        for (int i = 0; i < 8; ++i)
            ASSERT_TRUE(store.Add(FrameAt(i), 0, i == 0, Eigen::Isometry3d::Identity(), {}).ok());
    };
    FrameStore unlimited(100000000, 5000, ImageScratch("/absent"));
    fill(unlimited);
    const std::size_t limit = unlimited.memory_bytes() + 5000;
    FrameStore store(limit, 5000, ImageScratch("/absent"));
    fill(store);
    EXPECT_EQ(store.stride(), 1);
    for (int i = 0; i < 8; ++i) store.AddDetections(i, {MaskedDetection()});
    EXPECT_EQ(store.stride(), 2);
    EXPECT_LE(store.memory_bytes(), limit);
    ASSERT_EQ(store.frames().size(), 4u);
    for (const StoredFrame& frame : store.frames()) EXPECT_TRUE(frame.detections.has_value());
}

// Frames stored by an earlier process may be damaged. Loading reports an error, and the map is
// built from the others.
TEST(FrameStore, DamagedFramesAreRefusedAndLeftOutOfAMap) {
    FrameStore whole(100000000, 5000);
    for (int i = 0; i < 4; ++i)
        ASSERT_TRUE(
            whole.Add(FrameAt(i), 0, i == 0, SmoothPath(0).inverse() * SmoothPath(i), {}).ok());
    std::vector<StoredFrame> frames = whole.frames();
    EncodedImages half = *frames[1].images.Read().value(),
                  garbage = *frames[2].images.Read().value();
    half.depth_png.resize(half.depth_png.size() / 2);
    garbage.colour_jpeg.assign(30, 7);
    frames[1].images = StoredImages(std::move(half));
    frames[2].images = StoredImages(std::move(garbage));
    FrameStore damaged(100000000, 5000), sound(100000000, 5000);
    sound.Resume({frames[0], frames[3]}, 4);
    damaged.Resume(std::move(frames), 4);
    FieldSettings settings;
    settings.camera = SmallCamera();
    settings.map = {.voxel_size_m = 0.04, .truncation_m = 0.16};
    Frame frame;
    PreparedFrame prepared;
    for (const int i : {1, 2})
        EXPECT_FALSE(damaged
                         .LoadPrepared(damaged.frames()[static_cast<std::size_t>(i)],
                                       settings.camera, {}, frame, prepared)
                         .ok());
    EXPECT_TRUE(
        damaged.LoadPrepared(damaged.frames()[3], settings.camera, {}, frame, prepared).ok());
    EXPECT_FALSE(
        damaged.LoadPrepared(damaged.frames()[3], settings.camera.Every(2), {}, frame, prepared)
            .ok());
    MapRebuild with(settings, {Eigen::Isometry3d::Identity()}, nullptr),
        without(settings, {Eigen::Isometry3d::Identity()}, nullptr);
    ASSERT_TRUE(with.Step(damaged, 10).value());
    ASSERT_TRUE(without.Step(sound, 10).value());
    const auto a = with.TakeMap(), b = without.TakeMap();
    ASSERT_EQ(a->size(), b->size());
    for (BlockId id = 1; id < a->size(); ++id)
        ASSERT_TRUE(std::equal(a->weight(id), a->weight(id) + kBlockVoxels, b->weight(id))) << id;
}

// A map rebuilt in steps from the store is bit for bit the map fused from the same frames at the
// new poses, labels included.
TEST(MapRebuild, EqualsAFreshFusion) {
    const BlockMap::Config config{.voxel_size_m = 0.04, .truncation_m = 0.16};
    const Eigen::Isometry3d moved = Se3Exp((Vector6d() << 0.02, 0.1, 0, 0.3, 0, -0.1).finished());
    FrameStore store(100000000, 5000);
    const auto labeller = [] {
        return std::make_unique<LabelMapper>(LabelConfig{}, LabelClasses{}, SmallCamera());
    };
    const std::vector<Detection> detections{{"cup", 1, 0.9f, {10, 10, 50, 40}, {}}};
    BlockMap fresh(config);
    fresh.EnableLabels();
    const auto fresh_labels = labeller();
    Integrator integrator({}, SmallCamera());
    FieldSettings settings;
    settings.camera = SmallCamera();
    settings.map = config;
    MapRebuild rebuild(settings, {moved}, labeller());
    for (int i = 0; i < 6; ++i) {
        const Frame frame = FrameAt(i, false);
        const Eigen::Isometry3d T = SmoothPath(0).inverse() * SmoothPath(i);
        if (i == 4) {  // a keyframe that arrives during the rebuild
            EXPECT_FALSE(rebuild.Step(store, 3).value());
            rebuild.AddKeyframe(moved * moved);
        }
        ASSERT_TRUE(store.Add(frame, i < 4 ? 0 : 1, i == 0 || i == 4, T, {}).ok());
        PreparedFrame prepared;
        Frame stored;
        ASSERT_TRUE(store.Load(store.frames().back(), stored).ok());
        PrepareFrame(stored, {}, prepared);
        Integrator::View view;
        view.T_world_camera = (i < 4 ? moved : moved * moved) * T;
        integrator.Integrate(prepared, view, fresh);
        if (i % 4 != 0) continue;
        store.AddDetections(i, detections);
        fresh_labels->Label(detections, stored.depth_m, view.T_world_camera, fresh);
    }
    EXPECT_FALSE(rebuild.Step(store, 2).value());
    EXPECT_TRUE(rebuild.Step(store, 2).value());
    const std::unique_ptr<BlockMap> map = rebuild.TakeMap();
    int labelled = 0;
    ASSERT_EQ(map->size(), fresh.size());
    for (BlockId id = 1; id < fresh.size(); ++id) {
        ASSERT_TRUE(std::equal(fresh.field(id), fresh.field(id) + kBlockVoxels, map->field(id)));
        ASSERT_TRUE(std::equal(fresh.weight(id), fresh.weight(id) + kBlockVoxels, map->weight(id)));
        for (int v = 0; v < kBlockVoxels; ++v) {
            ASSERT_EQ(fresh.label(id)[v].count[0], map->label(id)[v].count[0]);
            labelled += map->label(id)[v].count[0] > 0;
        }
    }
    EXPECT_GT(labelled, 0);
}

// Ten frames show an object. The next eighty do, too, but no longer look for its class.
TEST(MapRebuild, ObjectsOfAClassThatWasIgnoredStay) {
    Frame frame = FrameAt(0, false);
    const Detection cup{"cup", 1, 0.9f, {60, 40, 110, 80}, Image<std::uint8_t>(51, 41, 1)};
    FieldSettings settings;
    settings.camera = SmallCamera();
    settings.map = {.voxel_size_m = 0.04, .truncation_m = 0.16};
    const auto stays = [&](const ClassSet& ignored) {
        FrameStore store(100000000, 5000);
        for (int i = 0; i < 90; ++i) {
            frame.index = i;
            EXPECT_TRUE(store.Add(frame, 0, i == 0, Eigen::Isometry3d::Identity(), {}).ok());
            if (i < 10)
                store.AddDetections(i, {cup});
            else
                store.AddDetections(i, {}, ignored);
        }
        MapRebuild rebuild(
            settings, {Eigen::Isometry3d::Identity()},
            std::make_unique<LabelMapper>(LabelConfig{}, LabelClasses{}, SmallCamera()));
        EXPECT_TRUE(rebuild.Step(store, 90).value());
        const std::unique_ptr<LabelMapper> labels = rebuild.TakeLabels();
        EXPECT_EQ(labels->instances().last(), 1);
        return labels->instances().last() == 1 && labels->instances().stands(1);
    };
    EXPECT_TRUE(stays(ClassSet().set(1)));
    EXPECT_FALSE(stays({}));
}

}  // namespace
}  // namespace tessera
