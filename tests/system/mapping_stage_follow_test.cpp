// A corrected map takes over what was fused while it was made.
#include <gtest/gtest.h>

#include <cstring>

#include "mapping/map_copier.h"
#include "support/box_room.h"
#include "system/mapping_stage.h"

namespace tessera {
namespace {

using testing_support::BoxRoom;
using testing_support::SmallCamera;
using testing_support::SmoothPath;

constexpr double kVoxel_m = 0.006;

PipelineConfig FineVoxels() {
    PipelineConfig config;
    config.map = {.voxel_size_m = kVoxel_m, .truncation_m = 0.03};
    return config;
}

// Fuses frames as seen by a camera in the moved map, and keeps a copy for tracking.
struct Followed {
    MappingStage mapping{FineVoxels(), {0, 0}, SmallCamera()};
    std::unique_ptr<BlockMap> copy =
        std::make_unique<BlockMap>(FineVoxels().map, BlockMap::Layers::kFieldOnly);

    Followed() { mapping.KeepDeltas(); }
    void Fuse(int i, const Eigen::Isometry3d& T_new_old = Eigen::Isometry3d::Identity()) {
        TrackedFrame tracked;
        PrepareFrame(BoxRoom().Render(SmallCamera(), SmoothPath(20 * i)), {}, tracked.prepared);
        tracked.view.T_world_camera = T_new_old * SmoothPath(20 * i);
        tracked.to_fuse = true;
        mapping.Fuse(tracked);
        Tell();
    }
    void Tell() {
        MapDelta delta;
        mapping.CollectDelta(delta);
        ApplyDelta(delta, *copy);
    }
};

template <class T>
bool SameVoxels(const T* a, const T* b) {
    return std::memcmp(a, b, kBlockVoxels * sizeof(T)) == 0;
}

// Everything moves by whole blocks, so that voxels are copied.
TEST(MappingStage, AMovedMapTakesOverWhatWasFusedMeanwhile) {
    const BlockCoord by{1, 0, -2};
    const Eigen::Isometry3d T_new_old(
        Eigen::Translation3d(kBlockSide * kVoxel_m * Eigen::Vector3d(by.x, by.y, by.z)));
    Followed world;
    for (int i = 0; i < 2; ++i) world.Fuse(i);
    const std::uint32_t moved_at = world.mapping.fused_frames();
    const std::unique_ptr<BlockMap> before =
        MapCopier().Copy(world.mapping.map(), moved_at, world.mapping.map().size());
    auto corrected = std::make_unique<BlockMap>(before->config());
    BlockMover mover = MoveRigidly(*before, ChangedSince(world.mapping.map(), 0), T_new_old, {});
    while (!mover.Step(*corrected)) continue;
    for (int i = 2; i < 5; ++i) world.Fuse(i);
    const std::unique_ptr<BlockMap> old = MapCopier().Copy(
        world.mapping.map(), world.mapping.fused_frames(), world.mapping.map().size());
    ASSERT_GT(old->count(), before->count() + 100);

    world.copy = CopyLayers(*corrected, BlockMap::Layers::kFieldOnly);
    world.mapping.ReplaceMoved(std::move(corrected), T_new_old, moved_at);
    ASSERT_TRUE(world.mapping.following());  // there is more than is moved at once
    world.Tell();
    world.Fuse(5, T_new_old);
    const BlockMap& map = world.mapping.map();
    const std::vector<BlockId> fresh = ChangedSince(map, world.mapping.fused_frames() - 1);
    const std::unique_ptr<BlockMap> fused =
        MapCopier().Copy(map, world.mapping.fused_frames(), map.size());
    while (world.mapping.following()) world.mapping.Follow();
    world.Tell();

    std::vector<bool> is_fresh(static_cast<std::size_t>(map.size()), false);
    int filled = 0;
    for (const BlockId id : fresh) {
        is_fresh[static_cast<std::size_t>(id)] = true;
        const BlockCoord c = map.coord(id);
        const FieldWord* now = fused->field(fused->Find(c));
        const FieldWord* moved = old->field(old->Find({c.x - by.x, c.y - by.y, c.z - by.z}));
        for (int v = 0; v < kBlockVoxels; ++v) {
            if (HasDistance(now[v])) {
                ASSERT_EQ(map.field(id)[v], now[v]);
            } else if (HasSurface(moved, old->config())) {
                ASSERT_EQ(map.field(id)[v], moved[v]);
                filled += HasDistance(moved[v]);
            }
        }
    }
    EXPECT_GT(filled, 1000);
    int compared = 0;
    for (BlockId id = 1; id < old->size(); ++id) {
        if (!HasSurface(old->field(id), old->config())) continue;
        const BlockCoord c = old->coord(id);
        const BlockId to = map.Find({c.x + by.x, c.y + by.y, c.z + by.z});
        ASSERT_NE(to, kUnknownBlock);
        if (is_fresh[static_cast<std::size_t>(to)]) continue;
        ++compared;
        ASSERT_TRUE(SameVoxels(map.field(to), old->field(id)));
        ASSERT_TRUE(SameVoxels(map.weight(to), old->weight(id)));
        ASSERT_TRUE(SameVoxels(map.colour(to), old->colour(id)));
    }
    EXPECT_GT(compared, 500);
    ASSERT_EQ(world.copy->size(), map.size());
    for (BlockId id = 1; id < map.size(); ++id)
        ASSERT_TRUE(SameVoxels(world.copy->field(id), map.field(id))) << id;
}

}  // namespace
}  // namespace tessera
