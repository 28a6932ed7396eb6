// The user changes the largest depth during a run, and the map is made again.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "optimize/loop_closer.h"
#include "support/box_room.h"

namespace tessera {
namespace {

using testing_support::BoxRoom;
using testing_support::SmallCamera;

// How far from the camera, along its axis, a map that is made again reaches, if a frame was seen
// with this limit. A ball is 0.9 m away, the wall behind it 1.9 m.
double ReachMadeAgain_m(double configured_m, double limit_m) {
    FieldSettings settings;
    settings.camera = SmallCamera();
    settings.map = {.voxel_size_m = 0.02, .truncation_m = 0.08};
    settings.preparation.max_depth_m = configured_m;
    BoxRoom room;
    room.has_ball = true;
    const Frame frame = room.Render(SmallCamera(), Eigen::Isometry3d::Identity());
    const auto see = [&](LoopCloser& closer) {
        PreparedFrame::Config preparation;
        preparation.max_depth_m = limit_m;
        PreparedFrame prepared;
        PrepareFrame(frame, preparation, prepared);
        prepared.limit_m = limit_m;
        TrackResult track;
        track.status = TrackStatus::kGood;
        closer.Add(frame, prepared, track, {}, true);
    };
    LoopCloser closer(LoopConfig{}, settings, 5000);
    see(closer);
    LoopCloser::Memory memory;
    memory.graph.keyframes.assign(closer.keyframes().all().begin(), closer.keyframes().all().end());
    memory.graph.keyframes[0].T_world_camera.translation().x() += 1;  // as a loop has shown
    memory.graph.corrected = true;
    memory.frames = closer.store().frames();
    memory.next_ordinal = 1;
    LoopCloser resumed(LoopConfig{}, settings, 5000);
    resumed.Resume(std::move(memory));
    see(resumed);
    std::optional<LoopCloser::Correction> correction = resumed.Step(10);
    if (!correction) return 0;
    const BlockMap& map = *correction->map;
    int farthest = 0;
    for (BlockId id = 1; id < map.size(); ++id) farthest = std::max(farthest, map.coord(id).z + 1);
    return farthest * kBlockSide * map.config().voxel_size_m;
}

TEST(DepthLimit, IsThatOfTheFramesInAMapThatIsMadeAgain) {
    EXPECT_GT(ReachMadeAgain_m(5, 5), 1.8);
    const double lowered_m = ReachMadeAgain_m(5, 1.4);
    EXPECT_GT(lowered_m, 0.9);
    EXPECT_LT(lowered_m, 1.6);
    EXPECT_GT(ReachMadeAgain_m(1.4, 5), 1.8);
}

}  // namespace
}  // namespace tessera
