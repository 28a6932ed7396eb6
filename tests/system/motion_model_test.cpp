#include "system/motion_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/box_room.h"

namespace tessera {
namespace {

using testing_support::SmoothPath;

TEST(MotionModel, ExpectsConstantVelocityAndForgetsItOverGaps) {
    MotionModel model({});
    EXPECT_TRUE(model.Predict(1.0).isApprox(Eigen::Isometry3d::Identity()));
    Vector6d step;
    step << 0.01, -0.02, 0.03, 0.1, 0.0, -0.1;
    const Eigen::Isometry3d T0 = SmoothPath(7);
    model.Add({0.0, T0}, {});
    EXPECT_TRUE(model.Predict(0.1).isApprox(T0));
    model.Add({0.1, T0 * Se3Exp(step)}, {});
    EXPECT_TRUE(model.Predict(0.2).isApprox(T0 * Se3Exp(2 * step), 1e-9));
    EXPECT_TRUE(model.Predict(0.15).isApprox(T0 * Se3Exp(1.5 * step), 1e-9));
    EXPECT_TRUE(model.Predict(5.0).isApprox(T0 * Se3Exp(step), 1e-9));  // too long ago
    EXPECT_EQ(model.SinceLast(5.0), 0);
}

TEST(MotionModel, MotionsThatNothingShowsComeToRest) {
    MotionModel::Config config;
    MotionModel model(config);
    Vector6d velocity;
    velocity << 0, 0, 0.1, 0.5, 0, 0;
    model.Add({0.0, Eigen::Isometry3d::Identity()}, {});
    model.Add({0.1, Se3Exp(0.1 * velocity)}, {});
    for (int i = 1; i <= 10; ++i) {
        const double stamp_s = 0.1 + 0.1 * i * config.come_to_rest_s;
        model.Add({stamp_s, model.Predict(stamp_s)}, {.degenerate = true});
    }
    const Vector6d left = Se3Log(model.last()->T_world_camera.inverse() *
                                 model.Predict(0.2 + config.come_to_rest_s)) /
                          0.1;
    EXPECT_LT((left - velocity * std::exp(-1.0)).norm(), 1e-3 * velocity.norm());
}

}  // namespace
}  // namespace tessera
