#include "viz/up_estimator.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tessera {
namespace {

void AddMany(UpEstimator& estimator, const Eigen::Vector3d& normal, int n) {
    for (int i = 0; i < n; ++i) {
        const Eigen::Vector3d noise =
            0.05 * Eigen::Vector3d(std::sin(i), std::sin(2.0 * i), std::sin(3.0 * i));
        estimator.Add(Eigen::Vector3f((normal + noise).normalized().cast<float>()));
    }
}

TEST(UpEstimator, FindsTheFloorBesideTheWalls) {
    // The camera is tilted 43 degrees downwards, so the world's y axis does not point down.
    const double tilt = 43 * M_PI / 180;
    const Eigen::Vector3d up(0, -std::cos(tilt), -std::sin(tilt));
    const Eigen::Vector3d wall = Eigen::Vector3d(0, std::sin(tilt), -std::cos(tilt));
    UpEstimator estimator({0, -1, 0});
    EXPECT_FALSE(estimator.Up());
    AddMany(estimator, wall, 2000);
    AddMany(estimator, {1, 0, 0}, 2000);
    EXPECT_FALSE(estimator.Up());
    AddMany(estimator, up, 1000);
    ASSERT_TRUE(estimator.Up());
    EXPECT_LT(std::acos(estimator.Up()->dot(up)), 0.01);
}

TEST(UpEstimator, ReadsPackedNormals) {
    BlockGeometry geometry;
    geometry.vertices.resize(8 * 600);
    for (GeometryVertex& vertex : geometry.vertices) vertex.normal = {0, -32767};
    UpEstimator estimator({0.2, -1, 0});
    estimator.Add(geometry);
    ASSERT_TRUE(estimator.Up());
    EXPECT_TRUE(estimator.Up()->isApprox(Eigen::Vector3d(0, -1, 0), 1e-4));
}

}  // namespace
}  // namespace tessera
