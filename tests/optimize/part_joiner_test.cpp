#include "optimize/part_joiner.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace tessera {
namespace {

const PinholeCamera kJoinerCamera{320, 240, 260, 260, 159.5, 119.5};

Eigen::Isometry3d AlongX(double x_m) { return Eigen::Isometry3d(Eigen::Translation3d(x_m, 0, 0)); }

// Two keyframes in each of three parts, 2 m apart along one wall 2 m away: they share little. The
// second part is half a metre ahead of the other two.
ScanGraph::Memory ThreeParts() {
    ScanGraph::Memory memory;
    for (int id = 0; id < 6; ++id) {
        Keyframe& keyframe = memory.keyframes.emplace_back();
        keyframe.id = id;
        keyframe.view = kJoinerCamera.Every(kKeyframeReduction);
        keyframe.depth_m = DepthImage(keyframe.view.width, keyframe.view.height, 2.0f);
        keyframe.T_map_camera = keyframe.T_world_camera = PartStart(id / 2) * AlongX(2 * (id % 2));
        keyframe.path_length_m = 2 * id;
        if (id % 2 == 1)
            memory.edges.push_back({id - 1, id, AlongX(2), RootInformation(0.01, 0.01), false});
    }
    return memory;
}

PlaceFinder::Place SeenFrom(int keyframe, double ahead_m) {
    PlaceFinder::Place place;
    place.keyframe = keyframe;
    place.T_old_new = AlongX(ahead_m);
    return place;
}

// One place of the second part and the third is known. Then the third is joined to the first, and
// so becomes the earlier of the two.
TEST(PartJoiner, RemembersPlacesOfPartsThatWereJoinedToOthersMeanwhile) {
    if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
    ScanGraph graph(LoopConfig{}, kJoinerCamera);
    graph.Resume(ThreeParts());
    PartJoiner joiner(graph);
    EXPECT_EQ(joiner.JoinAt({SeenFrom(2, 0), SeenFrom(4, 0.5)}), "");
    EXPECT_EQ(joiner.JoinAt({SeenFrom(0, 0), SeenFrom(4, 0)}), "");
    EXPECT_NE(joiner.JoinAt({SeenFrom(1, 0), SeenFrom(5, 0)}), "");
    EXPECT_EQ(graph.Parts(), (std::vector{0, 0, 2, 2, 0, 0}));
    EXPECT_NE(joiner.JoinAt({SeenFrom(3, 0), SeenFrom(5, 0.5)}), "");
    EXPECT_EQ(graph.Parts(), std::vector<int>(6, 0));
    for (const int id : {2, 3})
        EXPECT_NEAR(graph.keyframes()[id].T_world_camera.translation().x(), 2 * (id - 2) + 0.5,
                    0.01);
}

}  // namespace
}  // namespace tessera
