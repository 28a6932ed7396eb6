#include "optimize/scan_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "mapping/map_delta.h"
#include "optimize/map_corrector.h"
#include "optimize/part_motion.h"

namespace tessera {
namespace {

PoseEdge Edge(int from, int to) {
    PoseEdge edge;
    edge.from = from;
    edge.to = to;
    return edge;
}

// Each a kilometre from the last.
std::vector<Keyframe> Apart(int count) {
    std::vector<Keyframe> keyframes(static_cast<std::size_t>(count));
    for (int id = 0; id < count; ++id)
        keyframes[static_cast<std::size_t>(id)].T_world_camera = PartStart(id);
    return keyframes;
}

TEST(ScanParts, AreWhatEdgesJoin) {
    EXPECT_EQ(PartsOf({}, {}), std::vector<int>());
    EXPECT_EQ(PartsOf({}, Apart(3)), (std::vector{0, 1, 2}));
    const PoseEdge chain[] = {Edge(0, 1), Edge(1, 2), Edge(3, 4), Edge(4, 5)};
    EXPECT_EQ(PartsOf(chain, Apart(6)), (std::vector{0, 0, 0, 3, 3, 3}));
    // In any order and direction, and by way of a later keyframe.
    const PoseEdge joined[] = {Edge(5, 4), Edge(3, 5), Edge(1, 2), Edge(5, 1)};
    EXPECT_EQ(PartsOf(joined, Apart(6)), (std::vector{0, 1, 1, 1, 1, 1}));
}

// A scan that was repaired may lack some.
TEST(ScanParts, MissingEdgesMakeNoParts) {
    std::vector<Keyframe> keyframes = Apart(5);
    keyframes[3].T_world_camera = PartStart(1) * Eigen::Translation3d(20, 0, -30);
    const PoseEdge edge[] = {Edge(3, 4)};
    EXPECT_EQ(PartsOf(edge, keyframes), (std::vector{0, 1, 2, 1, 1}));
}

TEST(ScanParts, TheOneWithMostFramesIsKept) {
    EXPECT_TRUE(OutsideTheLargest({}, {}).empty());
    const int one[] = {0, 0, 0}, parts[] = {0, 1, 1, 0, 4}, frames[] = {3, 1, 5, 2, 5};
    EXPECT_TRUE(OutsideTheLargest(one, std::array{0, 0, 0}).empty());
    EXPECT_EQ(OutsideTheLargest(parts, frames), (std::vector{true, false, false, true, true}));
    EXPECT_EQ(OutsideTheLargest(parts, std::array{3, 1, 4, 2, 5}),
              (std::vector{false, true, true, false, true}))
        << "of equals the first";
}

TEST(ScanParts, BeginFarFromEachOther) {
    EXPECT_TRUE(PartStart(0).isApprox(Eigen::Isometry3d::Identity()));
    for (int a = 0; a <= kMostParts; ++a)
        for (int b = 0; b <= kMostParts; ++b)
            EXPECT_EQ(InOnePart(PartStart(a), PartStart(b)), a == b) << a << " " << b;
    // Single precision is then half a millimetre or less.
    for (int part = 0; part <= kMostParts; ++part)
        EXPECT_LE(PartStart(part).translation().lpNorm<Eigen::Infinity>(), 4096);
}

FieldSettings CoarseSettings() {
    FieldSettings settings;
    settings.camera = {320, 240, 262.5, 262.5, 159.5, 119.5};
    settings.map = {.voxel_size_m = 0.02, .truncation_m = 0.08};
    return settings;
}

// Of three parts one stays, one is moved there by whole blocks, and one is left out.
TEST(PartMotion, DoubtfulBlocksStaySo) {
    const BlockMap::Config config = CoarseSettings().map;
    const double block_m = kBlockSide * config.voxel_size_m;
    const int apart = static_cast<int>(std::lround(kPartsApart_m / block_m));
    BlockMap map(config);
    for (const int x : {0, 10, 11, apart, apart + 1, 2 * apart})
        std::fill_n(map.field(map.Allocate({x, 0, 0})), kBlockVoxels, FieldWord{0});
    ScanGraph graph(LoopConfig{}, CoarseSettings().camera);
    ScanGraph::Memory memory;
    for (int part = 0; part < 3; ++part) {
        Keyframe& keyframe = memory.keyframes.emplace_back();
        keyframe.id = part;
        keyframe.T_map_camera = keyframe.T_world_camera = PartStart(part);
    }
    graph.Resume(std::move(memory));
    graph.LeaveShortPartOut();
    graph.SetPoses(
        {PartStart(0), Eigen::Isometry3d(Eigen::Translation3d(3 * block_m, 0, 0)), PartStart(2)});
    const std::vector<BlockCoord> doubtful = {{10, 0, 0}, {apart, 0, 0}, {2 * apart, 0, 0}};
    MovedParts moved = MoveParts(map, graph, {}, doubtful);
    std::ranges::sort(moved.doubtful, std::less<>());
    EXPECT_EQ(moved.doubtful, (std::vector<BlockCoord>{{3, 0, 0}, {10, 0, 0}}));
    EXPECT_EQ(moved.map->count(), 5);
}

// Two keyframes that disagree make blocks doubtful. Then another part is left out.
TEST(MapCorrector, KeepsDoubtfulBlocksInMindWhenPartsAreLeftOut) {
    const FieldSettings settings = CoarseSettings();
    Frame wall;
    wall.depth_m = DepthImage(settings.camera.width, settings.camera.height, 2.0f);
    PreparedFrame prepared;
    PrepareFrame(wall, settings.preparation, prepared);
    BlockMap map(settings.map);
    Integrator(settings.fusion, settings.camera).Integrate(prepared, {}, map);
    ScanGraph graph(LoopConfig{}, settings.camera);
    for (const int part : {0, 0, 1}) {
        TrackResult track;
        track.T_world_camera = PartStart(part);
        graph.keyframes().Add(0, 0, prepared, track).T_world_camera = PartStart(part);
        graph.AddPassage(0, PartStart(part), true);
    }
    graph.MarkCorrected();
    graph.SetPoses(
        {PartStart(0), Eigen::Isometry3d(Eigen::Translation3d(0.2, 0, 0)), PartStart(1)});
    FrameStore store(1 << 20, 5000);
    MapCorrector corrector(settings, graph, store, std::nullopt, {});
    corrector.Move(CopyLayers(map, BlockMap::Layers::kAll));
    ASSERT_TRUE(corrector.moves_copy());
    std::unique_ptr<MapRebuild> made;
    while (!made) made = corrector.Step(1);
    ASSERT_TRUE(corrector.doubtful());
    graph.SetMapPoses(made->T_world_keyframe());
    const std::unique_ptr<BlockMap> in_use = made->TakeMap();
    EXPECT_EQ(graph.KeepLargestPart().find("1 frames are left out"), 0u);
    corrector.BeginParts(*in_use);
    ASSERT_NE(corrector.Step(1), nullptr);
    EXPECT_TRUE(corrector.doubtful());
}

}  // namespace
}  // namespace tessera
