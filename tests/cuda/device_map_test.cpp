#include "cuda/device_map.h"

#include <gtest/gtest.h>

#include "cuda/desk_frames.h"
#include "cuda/map_kernels.h"
#include "mapping/integrator.h"

namespace tessera::host {
namespace {

using testing_support::DeskCamera;
using testing_support::DeskFrame;
using testing_support::DeskFrames;
using testing_support::kPlenty;

const BlockMap::Config kMap{.voxel_size_m = 0.01, .truncation_m = 0.04};

Integrator::View At(const DeskFrame& frame) {
    Integrator::View view;
    view.T_world_camera = frame.T_world_camera;
    return view;
}

// A device map and a buffer for the depth of one frame.
struct MapRig {
    explicit MapRig(std::size_t limit_bytes = kPlenty)
        : memory(limit_bytes),
          depth(memory),
          tiles(memory),
          map(kMap.voxel_size_m, kMap.band(), memory, stream) {
        EXPECT_TRUE(map.Clear());
    }

    DeviceMap::Growth Allocate(const DeskFrame& frame, int max_new_blocks = 60000,
                               const WorldBox& box = {}) {
        const DepthImage& image = frame.prepared.depth_m;
        EXPECT_TRUE(depth.Reserve(stream, image.size(), 0));
        stream.Upload(depth.data(), image.data(), image.size() * sizeof(float));
        BandWalk walk = MakeBandWalk(frame.prepared, DeskCamera(), frame.T_world_camera, kMap);
        walk.depth_m = depth.data();
        return map.Allocate(walk, box, max_new_blocks);
    }

    Stream stream;
    DeviceMemory memory;
    DeviceBuffer<float> depth, tiles;
    DeviceMap map;
};

// Device memory is host memory here.
void ExpectSameIndex(MapRig& rig, const BlockMap& map) {
    DeviceMap& device = rig.map;
    rig.stream.Wait();
    const DeviceMapView view = device.view();
    const BlockMapView expected = map.view();
    ASSERT_EQ(device.size(), map.size());
    for (BlockId id = 0; id < map.size(); ++id) {
        for (int i = 0; i < 4; ++i)
            ASSERT_EQ(view.coords[4 * id + i], expected.coords[4 * id + i]) << id;
        for (int i = 0; i < 8; ++i)
            ASSERT_EQ(view.neighbours[8 * id + i], expected.neighbours[8 * id + i]) << id;
        ASSERT_TRUE(id == 0 || Find(view, CoordAt(view, id)) == id) << id;
    }
}

TEST(DeviceMap, AllocatesAsTheIntegratorDoes) {
    BlockMap map(kMap);
    Integrator integrator({}, DeskCamera());
    MapRig rig;
    for (const DeskFrame& frame : DeskFrames()) {
        integrator.Integrate(frame.prepared, At(frame), map);
        const DeviceMap::Growth growth = rig.Allocate(frame);
        ASSERT_EQ(growth.added.size(), integrator.added_blocks().size());
        for (std::size_t i = 0; i < growth.added.size(); ++i)
            ASSERT_EQ(growth.added[i], map.coord(integrator.added_blocks()[i]));
        EXPECT_FALSE(growth.full);
    }
    EXPECT_GT(map.size(), 1500);
    ExpectSameIndex(rig, map);
}

TEST(DeviceMap, SeesTheBlocksThatTheIntegratorSees) {
    BlockMap map(kMap);
    Integrator integrator({}, DeskCamera());
    MapRig rig;
    for (const DeskFrame& frame : DeskFrames()) {
        integrator.Integrate(frame.prepared, At(frame), map);
        rig.Allocate(frame);
        DepthTiles tiles;
        tiles.Build(frame.prepared.depth_m);
        const ViewCone cone =
            MakeViewCone(DeskCamera(), frame.T_world_camera, frame.prepared.farthest_m, kMap);
        const int count = rig.map.FindVisible(tiles.view(), cone);
        ASSERT_EQ(count, static_cast<int>(integrator.changed_blocks().size()));
        for (int i = 0; i < count; ++i)
            ASSERT_EQ(rig.map.visible()[i],
                      integrator.changed_blocks()[static_cast<std::size_t>(i)]);
    }
}

TEST(DeviceMap, TakesTheFirstInOrderWhereAFrameWantsTooMany) {
    Integrator::Config config;
    config.max_new_blocks = 500;
    BlockMap map(kMap);
    Integrator integrator(config, DeskCamera());
    MapRig rig;
    for (int i = 0; i < 3; ++i) {
        const DeskFrame& frame = DeskFrames()[static_cast<std::size_t>(i)];
        const Integrator::Report report = integrator.Integrate(frame.prepared, At(frame), map);
        const DeviceMap::Growth growth = rig.Allocate(frame, 500);
        EXPECT_EQ(static_cast<std::int64_t>(growth.added.size()), report.new_blocks);
        EXPECT_EQ(growth.wanted, report.new_blocks + report.refused_blocks);
        EXPECT_FALSE(growth.full);
    }
    ExpectSameIndex(rig, map);
}

TEST(DeviceMap, GrowsWithinItsLimitAndSaysWhereItEnds) {
    MapRig rig(std::size_t{14} << 20);
    std::int32_t size = 1;
    bool full = false;
    for (const DeskFrame& frame : DeskFrames()) {
        const DeviceMap::Growth growth = rig.Allocate(frame);
        size += static_cast<std::int32_t>(growth.added.size());
        EXPECT_EQ(rig.map.size(), size);
        EXPECT_EQ(growth.full, growth.wanted > static_cast<std::int64_t>(growth.added.size()));
        full |= growth.full;
        EXPECT_LE(rig.memory.used_bytes(), rig.memory.limit_bytes());
    }
    EXPECT_TRUE(full);
    EXPECT_GT(size, 1100);
    const DeviceMapView view = rig.map.view();
    for (std::int32_t id = 1; id < size; ++id) ASSERT_EQ(Find(view, CoordAt(view, id)), id);
    ASSERT_TRUE(rig.map.Clear());
    EXPECT_FALSE(rig.Allocate(DeskFrames()[0]).added.empty());  // the cleared map starts again
}

TEST(DeviceMap, GrowthAndDownloadLoseNoVoxel) {
    BlockMap map(kMap);
    Integrator integrator({}, DeskCamera());
    const auto fuse = [&](int i) {
        const DeskFrame& frame = DeskFrames()[static_cast<std::size_t>(i)];
        integrator.Integrate(frame.prepared, At(frame), map);
    };
    for (int i = 0; i < 3; ++i) fuse(i);
    MapRig rig;
    ASSERT_TRUE(
        rig.map.Load(map.size(), map.view().coords, map.field(0), map.weight(0), map.colour(0)));
    ExpectSameIndex(rig, map);
    const std::int32_t before = rig.map.size();
    // The camera turns and allocates new blocks until the pool has grown.
    for (int turn = 1; turn <= 6; ++turn) {
        DeskFrame turned = DeskFrames()[0];
        turned.T_world_camera.rotate(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY()));
        ASSERT_FALSE(rig.Allocate(turned).full);
    }
    ASSERT_GT(rig.map.size(), 3 * before);
    BlockVoxels voxels;
    std::int32_t next = 1;
    rig.map.DownloadSince(0, voxels, [&](const BlockVoxels& part) {
        for (std::size_t i = 0; i < part.ids.size(); ++i, ++next) {
            ASSERT_EQ(part.ids[i], next);
            for (std::size_t v = 0; v < kBlockVoxels; ++v) {
                const bool old = next < before;
                ASSERT_EQ(part.field[i * kBlockVoxels + v],
                          old ? map.field(next)[v] : kUnknownField)
                    << next;
                ASSERT_EQ(part.weight[i * kBlockVoxels + v], old ? map.weight(next)[v] : 0);
                ASSERT_EQ(part.colour[i * kBlockVoxels + v], old ? map.colour(next)[v] : kNoColour);
            }
        }
    });
    EXPECT_EQ(next, rig.map.size());
}

TEST(DeviceMap, KeysSortAsCoordinatesDo) {
    const BlockCoord coords[] = {{0, 0, -5},
                                 {3, 0, -1},
                                 {-kBlockLimit, -1, 0},
                                 {-2, 0, 0},
                                 {1, 0, 0},
                                 {-7, 1, 0},
                                 {0, 0, 1},
                                 {kBlockLimit - 1, -3, 7},
                                 {0, kBlockLimit - 1, kBlockLimit - 1}};
    for (const BlockCoord& a : coords) {
        EXPECT_EQ(CoordOf(KeyOf(a)), a);
        for (const BlockCoord& b : coords) EXPECT_EQ(a < b, KeyOf(a) < KeyOf(b));
    }
    EXPECT_NE(KeyOf({-kBlockLimit, -kBlockLimit, -kBlockLimit}), 0u);
}

}  // namespace
}  // namespace tessera::host
