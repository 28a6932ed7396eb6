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

// A phone is held sideways, to the left or to the right.
TEST(EstimateUp, KnowsCamerasThatWereHeldSideways) {
    TriangleMesh floor = BumpySheet(20, true);
    for (Eigen::Vector3f& p : floor.vertices) p.z() *= 0.02f;
    for (const double roll_rad : {1.5708, -1.5708}) {
        std::vector<StampedPose> path{Looking({1, 0, -0.4}), Looking({0, 1, -0.4}),
                                      Looking({-1, 0, -0.4}), Looking({0, -1, -0.4})};
        for (StampedPose& pose : path)
            pose.T_world_camera.rotate(Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ()));
        EXPECT_GT(EstimateUp(floor, path).z(), 0.999) << roll_rad;
    }
}

TEST(EstimateUp, WithoutAFloorFollowsTheCameras) {
    const std::vector<StampedPose> path{Looking({1, 0, 0}), Looking({0, 1, 0})};
    EXPECT_GT(EstimateUp({}, path).z(), 0.999);
    EXPECT_EQ(EstimateUp({}, {}), Eigen::Vector3d(0, -1, 0));
}

}  // namespace
}  // namespace tessera
