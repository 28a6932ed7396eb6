#include "optimize/session_join.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

const PinholeCamera kJoinCamera{320, 240, 260, 260, 159.5, 119.5};

Eigen::Isometry3d Shifted(double x_m, double turn_rad = 0) {
    return Eigen::Translation3d(x_m, 0, 0) *
           Eigen::Isometry3d(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY()));
}

// Keyframes every `step_m` along a wall 2 m away. Views a metre and a half apart share less than
// half.
std::vector<Keyframe> AlongAWall(int count, double step_m) {
    std::vector<Keyframe> keyframes(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        Keyframe& keyframe = keyframes[static_cast<std::size_t>(i)];
        keyframe.id = i;
        keyframe.view = kJoinCamera.Every(kKeyframeReduction);
        keyframe.depth_m = DepthImage(keyframe.view.width, keyframe.view.height, 2.0f);
        keyframe.T_map_camera = keyframe.T_world_camera = Shifted(i * step_m);
        keyframe.path_length_m = i * step_m;
    }
    return keyframes;
}

CommonPlace PlaceAt(int in_b, const Eigen::Isometry3d& T_world_a_in_b) {
    return {3, in_b, Eigen::Isometry3d::Identity(), T_world_a_in_b};
}

TEST(AgreeOnPose, TakesWhatMostPlacesSay) {
    const std::vector<Keyframe> b = AlongAWall(6, 1.0);
    const Eigen::Isometry3d T_a_b = Shifted(7, 0.4);
    std::vector<CommonPlace> places = {PlaceAt(4, Shifted(-20))};  // in another room
    for (const int id : {0, 2, 3, 5})
        places.push_back(PlaceAt(id, T_a_b * b[static_cast<std::size_t>(id)].T_world_camera));
    places[2].T_world_a_in_b.translation().x() += 0.05;  // drift
    const auto pose = AgreeOnPose(places, b);
    ASSERT_TRUE(pose.has_value());
    EXPECT_EQ(pose->places.size(), 4u);
    EXPECT_LT((pose->T_a_b.translation() - T_a_b.translation()).norm(), 0.06);
}

TEST(AgreeOnPose, ViewsOfOnePlaceAreNotEnough) {
    const std::vector<Keyframe> b = AlongAWall(6, 0.1);
    std::vector<CommonPlace> places;
    for (const int id : {0, 1, 2})
        places.push_back(PlaceAt(id, b[static_cast<std::size_t>(id)].T_world_camera));
    EXPECT_FALSE(AgreeOnPose(places, b).has_value());
    EXPECT_FALSE(AgreeOnPose({}, b).has_value());
}

TEST(AppendSession, MovesAndRenumbersWhatItAppends) {
    LoopCloser::Memory a, b;
    a.graph.keyframes = AlongAWall(2, 1.0);
    a.next_ordinal = 10;
    a.graph.loops = 1;
    b.graph.keyframes = AlongAWall(3, 1.0);
    b.graph.keyframes[2].overlaps.push_back({1, Shifted(1), Matrix6d::Identity(), std::nullopt});
    b.graph.edges.push_back({0, 1, Shifted(1), Matrix6d::Identity(), false});
    b.graph.passages.push_back({5.0, 2, Shifted(0.1)});
    b.frames.resize(1);
    b.frames[0].ordinal = 4;
    b.frames[0].keyframe = 1;
    b.next_ordinal = 5;
    const JointPose pose{Shifted(7), {{1, 2, Shifted(0.5), Shifted(9)}}};
    AppendSession(std::move(b), pose, a);
    ASSERT_EQ(a.graph.keyframes.size(), 5u);
    const Keyframe& last = a.graph.keyframes[4];
    EXPECT_EQ(last.id, 4);
    EXPECT_EQ(last.overlaps[0].with, 3);
    EXPECT_NEAR(last.T_world_camera.translation().x(), 9, 1e-12);
    EXPECT_NEAR(last.T_map_camera.translation().x(), 9, 1e-12);
    EXPECT_NEAR(last.path_length_m, 3, 1e-12);  // after a's metre
    ASSERT_EQ(a.graph.edges.size(), 2u);
    EXPECT_EQ(a.graph.edges[0].from, 2);
    EXPECT_EQ(a.graph.edges[0].to, 3);
    EXPECT_EQ(a.graph.edges[1].from, 1);  // the link
    EXPECT_EQ(a.graph.edges[1].to, 4);
    EXPECT_TRUE(a.graph.edges[1].loop);
    EXPECT_TRUE(a.graph.edges[1].T_from_to.isApprox(Shifted(0.5)));
    EXPECT_EQ(a.graph.passages[0].keyframe, 4);
    EXPECT_EQ(a.frames[0].ordinal, 14);
    EXPECT_EQ(a.frames[0].keyframe, 3);
    EXPECT_EQ(a.next_ordinal, 15);
    EXPECT_EQ(a.graph.loops, 2);
    EXPECT_TRUE(a.graph.corrected);
}

// Of both scans a part is left that nothing joins, and both began at the same place of their map.
TEST(AppendSession, PartsThatNothingJoinsStayApart) {
    LoopCloser::Memory scans[2];
    for (LoopCloser::Memory& scan : scans) {
        scan.graph.keyframes = AlongAWall(4, 1.0);
        for (const std::size_t id : {2u, 3u}) {
            Keyframe& keyframe = scan.graph.keyframes[id];
            keyframe.T_map_camera = keyframe.T_world_camera =
                PartStart(1) * Shifted(static_cast<double>(id) - 2);
        }
        for (const int id : {0, 2})
            scan.graph.edges.push_back({id, id + 1, Shifted(1), Matrix6d::Identity(), false});
    }
    LoopCloser::Memory& a = scans[0];
    AppendSession(std::move(scans[1]), {Shifted(7), {{1, 0, Shifted(6), Shifted(7)}}}, a);
    EXPECT_EQ(PartsOf(a.graph.edges, a.graph.keyframes), (std::vector{0, 0, 2, 2, 0, 0, 6, 6}));
    for (const int id : {6, 7}) {
        const Keyframe& keyframe = a.graph.keyframes[static_cast<std::size_t>(id)];
        EXPECT_TRUE(keyframe.T_map_camera.isApprox(PartStart(2) * Shifted(id - 6)));
        EXPECT_TRUE(keyframe.T_world_camera.isApprox(PartStart(2) * Shifted(id - 6)));
    }
}

}  // namespace
}  // namespace tessera
