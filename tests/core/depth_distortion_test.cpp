#include "core/depth_distortion.h"

#include <gtest/gtest.h>

#include <limits>

namespace tessera {
namespace {

TEST(PlaceInGrid, NodesAreAtTheCentresOfEqualParts) {
    // 8 x 6 pixels, parts of 2 x 3 pixels: the first node lies at (0.5, 1).
    const auto at = [](double u, double v) { return PlaceInGrid(u, v, 8, 6, 4, 2); };
    const GridPlace first = at(0.5, 1);
    EXPECT_EQ(first.column, 0);
    EXPECT_EQ(first.row, 0);
    EXPECT_EQ(first.right, 0);
    EXPECT_EQ(first.below, 0);
    const GridPlace between = at(3, 1.75);
    EXPECT_EQ(between.column, 1);
    EXPECT_FLOAT_EQ(between.right, 0.25f);
    EXPECT_FLOAT_EQ(between.below, 0.25f);
    const GridPlace corner = at(7, 5);  // beyond the last node
    EXPECT_EQ(corner.column, 2);
    EXPECT_EQ(corner.row, 0);
    EXPECT_EQ(corner.right, 1);
    EXPECT_EQ(corner.below, 1);
}

TEST(DepthDistortion, IsValidWithAFiniteValueForEachNode) {
    EXPECT_TRUE((DepthDistortion{2, 3, {0, 1, 2, 3, 4, 5}}).IsValid());
    EXPECT_FALSE((DepthDistortion{2, 3, {0, 1, 2, 3, 4}}).IsValid());
    EXPECT_FALSE((DepthDistortion{1, 2, {0, 1}}).IsValid());
    EXPECT_FALSE((DepthDistortion{-2, -3, {0, 1, 2, 3, 4, 5}}).IsValid());
    EXPECT_FALSE(DepthDistortion{}.IsValid());
    EXPECT_FALSE(
        (DepthDistortion{2, 2, {0, 1, 2, std::numeric_limits<float>::quiet_NaN()}}).IsValid());
}

TEST(DepthCorrection, TakesTheErrorFromTheInverseDepth) {
    // Nodes at columns 0.5 and 2.5; an error of 0.02 / m at the right and none at the left.
    const DepthCorrection correction({2, 2, {0, 0.02f, 0, 0.02f}}, 4, 4);
    DepthImage depth_m(4, 4, 2.0f);
    depth_m(3, 3) = 0;
    correction.Apply(5000, depth_m);
    for (int v = 0; v < 3; ++v) {
        EXPECT_NEAR(depth_m(0, v), 2, 1e-6);
        EXPECT_NEAR(depth_m(1, v), 1 / (0.5 - 0.005), 1.1e-4);
        EXPECT_NEAR(depth_m(3, v), 1 / (0.5 - 0.02), 1.1e-4);
    }
    EXPECT_EQ(depth_m(3, 3), 0);
}

TEST(DepthCorrection, RoundsToTheSourcesUnits) {
    const DepthCorrection correction({2, 2, {0.01f, 0.01f, 0.01f, 0.01f}}, 1, 1);
    DepthImage depth_m(1, 1, 2.0f);
    correction.Apply(1000, depth_m);
    EXPECT_FLOAT_EQ(depth_m(0, 0), 2.041f);  // 2.0408
}

TEST(DepthCorrection, WhatWouldGrowTenfoldIsNoMeasurement) {
    const DepthCorrection correction({2, 2, {0.1f, 0.1f, 0.1f, 0.1f}}, 2, 1);
    DepthImage depth_m(2, 1);
    depth_m(0, 0) = 8;
    depth_m(1, 0) = 9.5f;
    correction.Apply(1000, depth_m);
    EXPECT_NEAR(depth_m(0, 0), 40, 1e-3);
    EXPECT_EQ(depth_m(1, 0), 0);
}

TEST(DepthCorrection, LeavesOtherImagesAlone) {
    DepthImage depth_m(3, 2, 2.0f);
    DepthCorrection({2, 2, {1, 1, 1, 1}}, 4, 2).Apply(1000, depth_m);
    DepthCorrection({}, 3, 2).Apply(1000, depth_m);
    EXPECT_EQ(depth_m, DepthImage(3, 2, 2.0f));
}

}  // namespace
}  // namespace tessera
