// Tests of changes between two views: the map, the camera, the thread, the context.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <thread>

#include "render/mesh_rasteriser.h"
#include "render/rasteriser_fixture.h"

namespace tessera {
namespace {

using namespace testing_support;

// After changes the result equals that of a fresh rasteriser. Blocks that are meshed repeatedly
// reuse the same memory.
TEST_F(MeshRasteriserTest, AfterChangesTheSameAsAFreshOne) {
    BlockMap map{BlockMap::Config{}};
    FillScene(map);
    const Eigen::Isometry3d T = LookAt({.1, .2, -1}, {0, 0, .2});
    const PredictedView before = Draw(map, SmallCamera(), T);
    std::size_t bytes = 0;
    for (std::uint32_t revision = 2; revision < 16; ++revision) {
        const Sdf ball = Sphere({.2 * std::sin(revision), .2 * std::cos(revision), 0}, .15);
        for (BlockId id = 1; id < map.size(); ++id)
            if (Uniform(static_cast<std::uint32_t>(id) * 64 + revision) < .3)
                FillBlock(map, id, Union(SceneDistance, ball), nullptr, revision);
        if (revision == 8) map.MarkChanged(map.Allocate({3, 3, -5}), revision);
        const PredictedView changed = Draw(map, SmallCamera(), T);
        EXPECT_FALSE(SameBytes(before, changed));
        if (revision == 4) bytes = rasteriser_->bytes();
        if (revision % 5 != 0) continue;
        const auto fresh = Make();
        PredictedView expected;
        fresh->Predict(map, SmallCamera(), T, .1f, 5.f, expected);
        EXPECT_TRUE(SameBytes(changed, expected)) << revision;
    }
    EXPECT_LT(rasteriser_->bytes(), bytes + bytes / 3);
}

// A vertex normal can change although the lower neighbour, which also draws the vertex, reads no
// changed voxel. Here the normal on the edge from (0, 0, 7) upwards reads the changed block, while
// block (-1, 0, 0) does not.
TEST_F(MeshRasteriserTest, BorrowedVerticesFollowTheirOwners) {
    const Sdf plane = Plane({0, 0, -1}, -.075);
    BlockMap map{BlockMap::Config{}};
    Fill(map, plane, {-2, -2, -1}, {1, 1, 1});
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = Eigen::Vector3d(-.005, .005, -.03);
    const PredictedView before = Draw(map, SmallCamera(), T, .01f, 1.f);
    FillBlock(map, map.Find({0, -1, 1}), Plane({0, 0, -1}, -.079), nullptr, 2);
    const PredictedView changed = Draw(map, SmallCamera(), T, .01f, 1.f);
    // This pixel lies in block (-1, 0, 0).
    EXPECT_FALSE(changed.normal_camera(75, 55) == before.normal_camera(75, 55));
    PredictedView expected;
    Make()->Predict(map, SmallCamera(), T, .01f, 1.f, expected);
    EXPECT_TRUE(SameBytes(changed, expected));
}

// Data uploaded before the buffers grew must still be there.
TEST_F(MeshRasteriserTest, TheMapGrows) {
    BlockMap map{BlockMap::Config{}};
    FillScene(map);
    const Eigen::Isometry3d T = LookAt({.1, .2, -1}, {0, 0, .2});
    const PredictedView before = Draw(map, SmallCamera(), T);
    const std::size_t bytes = rasteriser_->bytes();
    Fill(map, Plane({0, 0, -1}, -6), {-20, -20, 73}, {19, 19, 76}, nullptr, 2);
    EXPECT_TRUE(SameBytes(Draw(map, SmallCamera(), T), before));
    EXPECT_GT(rasteriser_->bytes(), 2 * bytes);
    EXPECT_GT(CountHits(Draw(map, SmallCamera(), LookAt({0, 0, 5}, {0, 0, 6}))), 15000);
}

TEST_F(MeshRasteriserTest, AnotherOrClearedMapIsTakenUpFromScratch) {
    BlockMap first{BlockMap::Config{}};
    FillScene(first);
    const Eigen::Isometry3d T = LookAt({.1, .2, -1}, {0, 0, .2});
    const PredictedView before = Draw(first, SmallCamera(), T);
    BlockMap::Config coarse;
    coarse.voxel_size_m = .02;
    coarse.truncation_m = .08;
    BlockMap second{coarse};
    Fill(second, Sphere({0, 0, 0}, .3), {-3, -3, -3}, {2, 2, 2});
    const PredictedView ball = Draw(second, SmallCamera(), T);
    EXPECT_NEAR(CountHits(ball), CountHits(Cast(second, SmallCamera(), T)), 100);
    EXPECT_TRUE(SameBytes(Draw(first, SmallCamera(), T), before));
    first.Clear();
    EXPECT_EQ(CountHits(Draw(first, SmallCamera(), T)), 0);
    FillScene(first);  // the same blocks with the same revisions
    EXPECT_TRUE(SameBytes(Draw(first, SmallCamera(), T), before));
}

TEST_F(MeshRasteriserTest, CamerasMayChangeTheirSizeOrBeTooLarge) {
    BlockMap map{BlockMap::Config{}};
    FillScene(map);
    const Eigen::Isometry3d T = LookAt({.1, .2, -1}, {0, 0, .2});
    const PredictedView small = Draw(map, SmallCamera(), T);
    const PredictedView large = Draw(map, {321, 241, 280, 290, 159.5, 121.5}, T);
    EXPECT_EQ(large.depth_m.width(), 321);
    EXPECT_GT(CountHits(large), 3 * CountHits(small));
    EXPECT_TRUE(SameBytes(Draw(map, SmallCamera(), T), small));
    PredictedView nothing;
    rasteriser_->Predict(map, {1 << 20, 1, 280, 290, 0, 0}, T, .1f, 5.f, nothing);
    EXPECT_FALSE(rasteriser_->status().ok());
    EXPECT_EQ(CountHits(nothing), 0);
    EXPECT_TRUE(SameBytes(Draw(map, SmallCamera(), T), small));
}

TEST_F(MeshRasteriserTest, SameBytesForAnyNumberOfThreads) {
    BlockMap map{BlockMap::Config{}};
    FillScene(map);
    const auto with_threads = [&](std::size_t n) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, n);
        PredictedView view;
        Make()->Predict(map, SmallCamera(), LookAt({.1, .2, -1}, {0, 0, .2}), .1f, 5.f, view);
        return view;
    };
    EXPECT_TRUE(SameBytes(with_threads(1), with_threads(4)));
}

// The last context is released, two exist at the same time, and one is used on a different thread
// than it was created on.
TEST_F(MeshRasteriserTest, ContextsComeAndGo) {
    BlockMap map{BlockMap::Config{}};
    FillScene(map);
    const Eigen::Isometry3d T = LookAt({.1, .2, -1}, {0, 0, .2});
    const PredictedView expected = Draw(map, SmallCamera(), T);
    EXPECT_NE(rasteriser_->renderer().find("OpenGL"), std::string::npos);
    for (int i = 0; i < 3; ++i) {
        rasteriser_.reset();
        rasteriser_ = Make();
        ASSERT_TRUE(rasteriser_);
        const auto other = Make();
        PredictedView view;
        std::thread([&] { other->Predict(map, SmallCamera(), T, .1f, 5.f, view); }).join();
        EXPECT_TRUE(SameBytes(view, expected));
        EXPECT_TRUE(SameBytes(Draw(map, SmallCamera(), T), expected));
    }
}

}  // namespace
}  // namespace tessera
