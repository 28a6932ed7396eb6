#include "report/view_up.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "report/made_up_mesh.h"

namespace tessera {
namespace {

// A camera that looks along the given direction, upright with respect to z.
StampedPose Looking(const Eigen::Vector3d& forward) {
    StampedPose pose;
    const Eigen::Vector3d z = forward.normalized();
    const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
    pose.T_world_camera.linear() << x, z.cross(x), z;
    return pose;
}

TEST(EstimateUp, FindsTheFloorUnderACameraThatLooksDown) {
    TriangleMesh floor = BumpySheet(20);
    for (Eigen::Vector3f& p : floor.vertices) p.z() *= 0.02f;
    const std::vector<StampedPose> path{Looking({1, 0, -0.4}), Looking({1, 0.2, -0.5})};
    EXPECT_GT(EstimateUp(floor, path).z(), 0.999);
}

TEST(EstimateUp, WithoutAFloorFollowsTheCameras) {
    const std::vector<StampedPose> path{Looking({1, 0, 0}), Looking({0, 1, 0})};
    EXPECT_GT(EstimateUp({}, path).z(), 0.999);
    EXPECT_EQ(EstimateUp({}, {}), Eigen::Vector3d(0, -1, 0));
}

}  // namespace
}  // namespace tessera
