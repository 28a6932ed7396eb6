#include "finish/nearest_depth.h"

#include <gtest/gtest.h>

#include "finish/meshes.h"
#include "finish/wall_frames.h"

namespace tessera {
namespace {

using testing_support::WallCamera;

TriangleMesh Points(const std::vector<Eigen::Vector3f>& points) {
    TriangleMesh mesh;
    mesh.vertices = points;
    return mesh;
}

TEST(NearestDepth, TheNearestPoseThatHasThePlaceInItsImageCounts) {
    Eigen::Isometry3d back = Eigen::Isometry3d::Identity(), turned = Eigen::Isometry3d::Identity();
    back.translation().z() = -2;
    turned.linear() = Eigen::AngleAxisd(3.14159, Eigen::Vector3d::UnitY()).toRotationMatrix();
    const std::vector<StampedPose> path{{0, back}, {1, turned}, {2, Eigen::Isometry3d::Identity()}};
    // Ahead of all; beside the nearer one's image; behind all but the turned one; seen by none.
    const TriangleMesh mesh = Points({{0, 0, 1}, {0.9f, 0, 1}, {0, 0, -3}, {9, 0, 1}});
    const std::vector<float> depths_m = NearestDepths_m(mesh, WallCamera(), path);
    EXPECT_NEAR(depths_m[0], 1, 1e-5f);
    EXPECT_NEAR(depths_m[1], 3, 1e-5f);
    EXPECT_NEAR(depths_m[2], 3, 1e-4f);
    EXPECT_NEAR(depths_m[3], 3, 1e-4f);  // the largest of the others
}

TEST(NearestDepth, OfALongPathOnlySomePosesAreUsed) {
    std::vector<StampedPose> path;
    for (int i = 0; i < 1000; ++i) {
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.translation().z() = -0.001 * i;
        path.push_back({static_cast<double>(i), T});
    }
    const auto depths_m = NearestDepths_m(Points({{0, 0, 1}}), WallCamera(), path);
    EXPECT_NEAR(depths_m[0], 1, 0.01f);
    EXPECT_NEAR(NearestDepths_m(Points({{0, 0, 1}}), WallCamera(), {})[0], 0.4f, 1e-6f);
}

}  // namespace
}  // namespace tessera
