#include "cuda/device_views.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "cuda/desk_frames.h"
#include "cuda/device_pipeline.h"
#include "cuda/device_rays.h"
#include "mapping/integrator.h"
#include "mapping/ray_caster.h"

namespace tessera::host {
namespace {

using testing_support::DeskCamera;
using testing_support::DeskFrame;
using testing_support::DeskFrames;
using testing_support::ExpectSameView;
using testing_support::FusedDesk;
using testing_support::kPlenty;

// Device memory is host memory here.
void ExpectSameRanges(const BlockMap& map, const PinholeCamera& camera,
                      const Eigen::Isometry3d& T_world_camera, float min_depth_m, float max_depth_m,
                      bool all_regions) {
    RayRanges expected;
    expected.Build(map, camera, T_world_camera, min_depth_m, max_depth_m);
    const RangeArguments a =
        MakeRangeArguments(map, camera, T_world_camera, min_depth_m, max_depth_m);
    EXPECT_EQ(a.all_regions, all_regions);
    std::vector<RayRange> ranges(expected.ranges.size());
    ASSERT_EQ(ranges.size(), static_cast<std::size_t>(a.width * a.height));
    Stream stream;
    FindRayRanges(stream, a, map.view().coords, map.size(), ranges.data());
    stream.Wait();
    EXPECT_EQ(std::memcmp(ranges.data(), expected.ranges.data(), ranges.size() * sizeof(RayRange)),
              0);
}

TEST(FindRayRanges, AreTheProcessors) {
    BlockMap map{BlockMap::Config()};
    FusedDesk(5, map);
    for (const DeskFrame& frame : DeskFrames()) {
        const Eigen::Isometry3d& T_world_camera = frame.T_world_camera;
        ExpectSameRanges(map, DeskCamera(), T_world_camera, 0.1f, 8.0f, true);
        ExpectSameRanges(map, {157, 117, 131, 133, 70.5, 61.5}, T_world_camera, 0.6f, 1.5f, false);
    }
}

// Adds so many distant blocks that only the regions in view are searched.
TEST(FindRayRanges, LookAtTheBlocksThatTheProcessorLooksAt) {
    BlockMap map{BlockMap::Config()};
    FusedDesk(1, map);
    for (int i = 0; i < 40000; ++i) map.Allocate({1000 + i % 200, i / 200, 0});
    ExpectSameRanges(map, DeskCamera(), Eigen::Isometry3d::Identity(), 0.1f, 1.5f, false);
}

// Poses of the camera, poses near them, and poses among the blocks.
std::vector<Eigen::Isometry3d> Poses() {
    std::vector<Eigen::Isometry3d> poses;
    for (std::size_t i = 0; i < DeskFrames().size(); i += 3) {
        const Eigen::Isometry3d& T = DeskFrames()[i].T_world_camera;
        poses.push_back(T);
        poses.push_back(T * Eigen::Translation3d(0.2, -0.1, 0.3) *
                        Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()));
        poses.push_back(T * Eigen::Translation3d(-0.1, 0.1, 0.8) *
                        Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitX()));
    }
    return poses;
}

int CountHits(const PredictedView& view) {
    const float* begin = view.depth_m.data();
    return static_cast<int>(
        std::count_if(begin, begin + view.depth_m.size(), [](float d) { return d > 0; }));
}

TEST(DeviceViews, AreTheBytesOfTheProcessor) {
    BlockMap map{BlockMap::Config()};
    FusedDesk(10, map);
    DevicePipeline device("host", kPlenty);
    DeviceViews views(device);
    RayCaster caster;
    PredictedView expected, view;
    for (const PinholeCamera& camera :
         {DeskCamera(), DeskCamera().Every(2), PinholeCamera{157, 117, 131, 133, 70.5, 61.5}}) {
        int hits = 0, near_hits = 0, pixels = 0;
        for (const Eigen::Isometry3d& T_world_camera : Poses()) {
            caster.Predict(map, camera, T_world_camera, 0.1f, 6.0f, expected);
            views.Predict(map, camera, T_world_camera, 0.1f, 6.0f, view);
            ExpectSameView(view, expected);
            hits += CountHits(view);
            pixels += camera.width * camera.height;
            caster.Predict(map, camera, T_world_camera, 0.6f, 1.1f, expected);
            views.Predict(map, camera, T_world_camera, 0.6f, 1.1f, view);
            ExpectSameView(view, expected);
            near_hits += CountHits(view);
        }
        EXPECT_GT(hits, pixels / 2);
        EXPECT_GT(near_hits, pixels / 20);
        EXPECT_LT(near_hits, hits / 2);
    }
}

TEST(DeviceViews, ShowNothingWhereThereIsNoRoom) {
    BlockMap map{BlockMap::Config()};
    FusedDesk(1, map);
    DevicePipeline device("host", std::size_t{1} << 20);
    PredictedView view;
    device.views().Predict(map, DeskCamera(), DeskFrames()[0].T_world_camera, 0.1f, 6.0f, view);
    ASSERT_EQ(view.depth_m.size(), 160u * 120u);
    EXPECT_EQ(CountHits(view), 0);
}

}  // namespace
}  // namespace tessera::host
