#include "semantics/instance_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/rasteriser_fixture.h"

namespace tessera {
namespace {

using namespace testing_support;

InstanceId Nothing(const Eigen::Vector3d&) { return 0; }

// Cubes of 13 cm with distant numbers, and a side without votes.
InstanceId Cubes(const Eigen::Vector3d& p) {
    if (p.x() < -.4) return 0;
    const Eigen::Vector3i cube = (p / .13).array().floor().cast<int>();
    return static_cast<InstanceId>(30011 + 1009 * cube.x() + 10007 * cube.y() + 331 * cube.z());
}

class InstanceViewTest : public ::testing::Test {
  protected:
    InstanceViewTest() {
        map.EnableLabels();
        FillScene(map);
        for (BlockId id = 1; id < map.size(); ++id) Vote(id, Cubes);
    }
    void SetUp() override {
        if (const auto made = MeshRasteriser::Create({}); !made.ok())
            GTEST_SKIP() << made.message();
    }
    void Vote(BlockId id, InstanceId (*instance_at)(const Eigen::Vector3d& p)) {
        for (int i = 0; i < kBlockVoxels; ++i) {
            VoxelLabel& voxel = map.label(id)[i];
            voxel = {};
            voxel.instance = instance_at(WorldVoxel(map.coord(id), i).cast<double>() *
                                         map.config().voxel_size_m);
            voxel.count[0] = voxel.class_id[0] = voxel.instance != 0;
        }
    }
    Image<InstanceId> Show(InstanceView& view) {
        Image<InstanceId> shown;
        view.Predict(map, camera, T, .1f, 5.f, shown);
        EXPECT_EQ(shown.width(), camera.width);
        EXPECT_EQ(shown.height(), camera.height);
        return shown;
    }

    BlockMap map{BlockMap::Config{}};
    // An odd width: rows are not a multiple of four bytes.
    PinholeCamera camera{321, 240, 270, 290, 150.25, 131};
    Eigen::Isometry3d T = LookAt({.1, .2, -1}, {0, 0, .2});
    InstanceView cast{LabelPrediction::kRayCast}, drawn{LabelPrediction::kRaster};
};

// Whether the pixel and its neighbours have one label.
bool IsUniform(const Image<InstanceId>& image, int u, int v) {
    for (int dv = -1; dv <= 1; ++dv)
        for (int du = -1; du <= 1; ++du)
            if (image(u + du, v + dv) != image(u, v)) return false;
    return true;
}

// Triangles are as large as voxels, which here are two to four pixels, and have one label each. So
// labels may differ next to an edge.
TEST_F(InstanceViewTest, RasterisedAsRayCastAwayFromEdges) {
    for (const Eigen::Vector3d& eye :
         {Eigen::Vector3d(.1, .2, -1), Eigen::Vector3d(.7, -.6, -.5)}) {
        T = LookAt(eye, {0, 0, .2});
        const Image<InstanceId> expected = Show(cast), shown = Show(drawn);
        int compared = 0, same = 0, labelled = 0, same_anywhere = 0;
        for (int v = 1; v + 1 < camera.height; ++v)
            for (int u = 1; u + 1 < camera.width; ++u) {
                same_anywhere += shown(u, v) == expected(u, v);
                if (!IsUniform(expected, u, v) || !IsUniform(shown, u, v)) continue;
                ++compared;
                same += shown(u, v) == expected(u, v);
                labelled += expected(u, v) != 0;
            }
        EXPECT_GT(labelled, 20000);
        EXPECT_GT(same, .995 * compared) << same << " of " << compared;
        EXPECT_GT(same_anywhere, .9 * camera.width * camera.height);
    }
}

// Only the blocks that got votes are labelled again.
TEST_F(InstanceViewTest, VotesShowInTheNextView) {
    const Image<InstanceId> before = Show(drawn);
    EXPECT_TRUE(Show(drawn) == before);
    std::vector<BlockId> voted;
    for (BlockId id = 1; id < map.size(); ++id) {
        Vote(id, Nothing);
        if (map.coord(id).y < 0) voted.push_back(id);
    }
    drawn.Voted(voted);
    const Image<InstanceId> after = Show(drawn);
    int cleared = 0, kept = 0;
    for (int v = 0; v < camera.height; ++v)
        for (int u = 0; u < camera.width; ++u) {
            if (before(u, v) == 0) continue;
            ASSERT_TRUE(after(u, v) == 0 || after(u, v) == before(u, v));
            ++(after(u, v) == 0 ? cleared : kept);
        }
    EXPECT_GT(cleared, 5000);
    EXPECT_GT(kept, 5000);
    voted.clear();
    for (BlockId id = 1; id < map.size(); ++id) voted.push_back(id);
    drawn.Voted(voted);
    EXPECT_TRUE(Show(drawn) == Image<InstanceId>(camera.width, camera.height, 0));
}

// The votes of a block that is no longer there when they would be shown.
TEST_F(InstanceViewTest, VotedBlocksMayBeReleased) {
    Show(drawn);
    std::vector<BlockId> voted;
    for (BlockId id = 1; id < map.size(); id += 3) voted.push_back(id);
    drawn.Voted(voted);
    for (const BlockId id : voted) map.Release(id);
    const Image<InstanceId> shown = Show(drawn);
    InstanceView fresh{LabelPrediction::kRaster};
    EXPECT_TRUE(shown == Show(fresh));
    drawn.Voted(voted);
    map.Clear();
    EXPECT_TRUE(Show(drawn) == Image<InstanceId>(camera.width, camera.height, 0));
}

TEST_F(InstanceViewTest, SourcesCanBeSwitched) {
    const Image<InstanceId> rays = Show(cast), mesh = Show(drawn);
    EXPECT_FALSE(rays == mesh);
    cast.Select(LabelPrediction::kRaster);
    EXPECT_TRUE(Show(cast) == mesh);
    cast.Select(LabelPrediction::kRayCast);
    EXPECT_TRUE(Show(cast) == rays);
}

TEST_F(InstanceViewTest, CastsRaysIfTheDriverCannotDraw) {
    camera.width = 1 << 16;  // more than any driver can draw
    camera.height = 1;
    const Image<InstanceId> expected = Show(cast);
    EXPECT_TRUE(Show(drawn) == expected);
    EXPECT_NE(drawn.warning().find("predicting labels by ray casting: cannot draw a view of"),
              std::string::npos)
        << drawn.warning();
    EXPECT_TRUE(cast.warning().empty());
}

}  // namespace
}  // namespace tessera
