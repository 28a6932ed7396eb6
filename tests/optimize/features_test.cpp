#include "optimize/features.h"

#include <gtest/gtest.h>

#include "support/box_room.h"

namespace tessera {
namespace {

// A dark square on a bright plane one metre away, with corners at known points.
PreparedFrame SquarePicture(float depth_m) {
    PreparedFrame frame;
    frame.has_colour = true;
    frame.intensity = Image<float>(160, 120, 0.9f);
    for (int y = 40; y < 80; ++y)
        for (int x = 60; x < 100; ++x) frame.intensity(x, y) = 0.1f;
    frame.depth_m = DepthImage(160, 120, depth_m);
    return frame;
}

TEST(Features, LieAtTheCornersWithTheirDepth) {
    const PinholeCamera camera = testing_support::SmallCamera();
    const Features features = ExtractFeatures(SquarePicture(1.0f), camera, 50);
    ASSERT_GT(features.size(), 3u);
    ASSERT_EQ(features.descriptors.size(), features.p_camera.size());
    for (const Eigen::Vector3f& p : features.p_camera) {
        EXPECT_FLOAT_EQ(p.z(), 1.0f);
        const Eigen::Vector2d uv = camera.Project(p.cast<double>());
        const double dx = std::min(std::abs(uv.x() - 59.5), std::abs(uv.x() - 99.5));
        const double dy = std::min(std::abs(uv.y() - 39.5), std::abs(uv.y() - 79.5));
        EXPECT_LT(std::max(dx, dy), 8) << uv.transpose();
    }
}

TEST(Features, NoneWithoutDepthOrColour) {
    EXPECT_EQ(ExtractFeatures(SquarePicture(0.0f), testing_support::SmallCamera(), 50).size(), 0u);
    PreparedFrame grey = SquarePicture(1.0f);
    grey.has_colour = false;
    EXPECT_EQ(ExtractFeatures(grey, testing_support::SmallCamera(), 50).size(), 0u);
}

TEST(Features, HammingDistanceCountsBits) {
    EXPECT_EQ(HammingDistance({}, {}), 0);
    EXPECT_EQ(HammingDistance({1, 0, 3, 0}, {0, 0, 0, ~std::uint64_t{0}}), 67);
}

}  // namespace
}  // namespace tessera
