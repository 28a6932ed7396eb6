// Which pairs of keyframes are aligned, and which are not tried again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "optimize/overlaps.h"
#include "optimize/painted_corner.h"

namespace tessera {
namespace view_test {
namespace {

// A view with which nothing can be aligned.
ReducedView BlankView() {
    ReducedView blank = ReducedFrom(Eigen::Isometry3d::Identity());
    std::fill_n(blank.depth.data(), blank.depth.size(), std::uint16_t{0});
    return blank;
}

// Of a wall 2 m away, as the graph sees it; without a view of their own.
Keyframes KeyframesOfAWall(int count) {
    std::vector<Keyframe> list(static_cast<std::size_t>(count));
    for (int id = 0; id < count; ++id) {
        Keyframe& keyframe = list[static_cast<std::size_t>(id)];
        keyframe.id = id;
        keyframe.view = kViewCamera.Every(kKeyframeReduction);
        keyframe.depth_m = DepthImage(keyframe.view.width, keyframe.view.height, 2.0f);
    }
    Keyframes keyframes(kViewCamera, 0.8, 100);
    keyframes.Resume(std::move(list));
    return keyframes;
}

void Put(Keyframe& keyframe, const Eigen::Isometry3d& T_world_camera, ReducedView view) {
    keyframe.T_map_camera = keyframe.T_world_camera = T_world_camera;
    keyframe.reduced = std::move(view);
}

const Eigen::Isometry3d kThere = Moved(0.12, 0.2);

// Keyframes behind a wall share all, by their depth and poses, and cannot be aligned.
TEST(OverlapFinder, EightThatCannotBeAlignedDoNotHideTheNinth) {
    Keyframes keyframes = KeyframesOfAWall(31);
    Put(keyframes[30], kThere, ReducedFrom(kThere));
    for (int id = 2; id <= 16; id += 2) Put(keyframes[id], kThere, BlankView());
    Put(keyframes[0], Eigen::Isometry3d::Identity(), ReducedFrom(Eigen::Isometry3d::Identity()));
    OverlapFinder finder(kViewCamera);
    EXPECT_EQ(finder.Find(keyframes, 30, true), 1);
    ASSERT_EQ(keyframes[30].overlaps.size(), 1u);
    EXPECT_EQ(keyframes[30].overlaps[0].with, 0);
}

// The view that could not be aligned is put right, which only somebody who looks again can see.
TEST(OverlapFinder, WhatFailedIsTriedAgainFromAnotherPoseOnly) {
    Keyframes keyframes = KeyframesOfAWall(2);
    Put(keyframes[0], Eigen::Isometry3d::Identity(), BlankView());
    Put(keyframes[1], kThere, ReducedFrom(kThere));
    OverlapFinder finder(kViewCamera);
    EXPECT_EQ(finder.Find(keyframes, 1, false), 0);
    keyframes[0].reduced = ReducedFrom(Eigen::Isometry3d::Identity());
    Keyframe other;
    other.reduced = BlankView();
    for (other.id = 100; other.id < 116; ++other.id) finder.ViewOf(other);  // instead of the old
    EXPECT_EQ(finder.Find(keyframes, 1, false), 0);
    keyframes[1].T_world_camera = kThere * Eigen::Translation3d(0.0001, 0, 0);
    EXPECT_EQ(finder.Find(keyframes, 1, false), 0);
    keyframes[1].T_world_camera = kThere * Eigen::Translation3d(0.05, 0, 0);
    EXPECT_EQ(finder.Find(keyframes, 1, false), 1);
}

// So that a resumed scan, which does not know what failed, gives the same bytes.
TEST(OverlapFinder, FromNearlyTheSamePoseTheSameComesOut) {
    Eigen::Matrix4d aligned[2];
    for (const int k : {0, 1}) {
        Keyframes keyframes = KeyframesOfAWall(2);
        Put(keyframes[0], Eigen::Isometry3d::Identity(),
            ReducedFrom(Eigen::Isometry3d::Identity()));
        Put(keyframes[1], kThere * Eigen::Translation3d(0.0001 * k, 0, 0), ReducedFrom(kThere));
        OverlapFinder finder(kViewCamera);
        ASSERT_EQ(finder.Find(keyframes, 1, false), 1);
        aligned[k] = keyframes[1].overlaps[0].T_with_this_aligned.matrix();
    }
    EXPECT_EQ(aligned[0], aligned[1]);
}

}  // namespace
}  // namespace view_test
}  // namespace tessera
