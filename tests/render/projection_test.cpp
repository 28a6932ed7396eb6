#include "render/projection.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace tessera {
namespace {

// Window position in pixels and depth buffer value, as OpenGL computes them from clip space.
Eigen::Vector3d Window(const PinholeCamera& camera, const Eigen::Vector4d& clip) {
    const Eigen::Vector3d ndc = clip.head<3>() / clip.w();
    return {(ndc.x() + 1) / 2 * camera.width, (ndc.y() + 1) / 2 * camera.height, (ndc.z() + 1) / 2};
}

TEST(Projection, DepthBufferByHand) {
    // near 0.5, far 2: 2 / 1.5 * (1 - 0.5 / z).
    EXPECT_DOUBLE_EQ(DepthBufferValue(.5, .5, 2), 0);
    EXPECT_DOUBLE_EQ(DepthBufferValue(2, .5, 2), 1);
    EXPECT_DOUBLE_EQ(DepthBufferValue(1, .5, 2), 2. / 3);
    EXPECT_DOUBLE_EQ(DepthFromBuffer(0, .5, 2), .5);
    EXPECT_DOUBLE_EQ(DepthFromBuffer(1, .5, 2), 2);
    EXPECT_DOUBLE_EQ(DepthFromBuffer(2. / 3, .5, 2), 1);
    EXPECT_DOUBLE_EQ(DepthFromBuffer(.5, .5, 2), .8);
}

TEST(Projection, MatrixAndDepthBufferAgree) {
    const PinholeCamera camera{160, 120, 140, 150, 70.25, 66.5};
    const Eigen::Matrix4d clip_from_camera = ClipFromCamera(camera, .2, 7);
    for (const double z : {.2, .5, 1., 3., 6.9999, 7.})
        for (const Eigen::Vector2d& pixel :
             {Eigen::Vector2d(0, 0), Eigen::Vector2d(159, 7), Eigen::Vector2d(33.5, 119)}) {
            const Eigen::Vector3d p = camera.Unproject(pixel.x(), pixel.y(), z);
            const Eigen::Vector3d window = Window(camera, clip_from_camera * p.homogeneous());
            EXPECT_NEAR(window.x(), pixel.x() + .5, 1e-10);
            EXPECT_NEAR(window.y(), pixel.y() + .5, 1e-10);
            EXPECT_NEAR(window.z(), DepthBufferValue(z, .2, 7), 1e-12);
            EXPECT_NEAR(DepthFromBuffer(window.z(), .2, 7), z, 1e-10);
        }
}

// [D18] eq. 13: if the principal point is at the image centre, the top and bottom of the image are
// VFOV apart.
TEST(Projection, FieldOfView) {
    const PinholeCamera camera{640, 480, 525, 525, 319.5, 239.5};
    const double half = std::atan(.5 * 480 / 525);
    const Eigen::Vector3d top(0, -std::tan(half), 1);
    EXPECT_NEAR(Window(camera, ClipFromCamera(camera, .1, 100) * top.homogeneous()).y(), 0, 1e-10);
}

}  // namespace
}  // namespace tessera
