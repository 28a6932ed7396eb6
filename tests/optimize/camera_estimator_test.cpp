// A painted box-shaped room, seen without noise by a rotating camera whose given intrinsics may be
// wrong.
#include "optimize/camera_estimator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "optimize/camera_pair.h"

namespace tessera {
namespace {

const PinholeCamera kCamera{320, 240, 270, 270, 159.5, 119.5};
const Eigen::Vector3d kHalfRoom(2.0, 1.3, 2.4);

double Paint(const Eigen::Vector3d& p) {
    return 0.5 + 0.16 * std::sin(9 * p.x() + 2 * p.z()) * std::sin(8 * p.y() + 1) +
           0.14 * std::sin(7 * p.z() - 5 * p.y()) +
           0.12 * std::sin(15 * p.x() - 4 * p.y() + 11 * p.z());
}

// A frame on a slow, shaky path that starts near the origin and rotates about all axes.
Frame View(int number, double readout_s) {
    const auto pose = [](double t) {
        return Eigen::Isometry3d(
            Eigen::Translation3d(0.1 * std::sin(t), 0.05 * std::cos(1.7 * t),
                                 0.1 * std::sin(0.8 * t)) *
            Eigen::AngleAxisd(0.35 * std::sin(0.9 * t), Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(0.25 * std::sin(1.4 * t + 0.5), Eigen::Vector3d::UnitX()) *
            Eigen::AngleAxisd(0.15 * std::sin(0.6 * t), Eigen::Vector3d::UnitZ()));
    };
    Frame frame;
    frame.stamp_s = frame.colour_stamp_s = 0.1 * number;
    frame.colour.Resize(kCamera.width, kCamera.height);
    frame.depth_m.Resize(kCamera.width, kCamera.height);
    for (int v = 0; v < kCamera.height; ++v) {
        const Eigen::Isometry3d T = pose(frame.stamp_s + readout_s * (v / 240.0 - 0.5));
        for (int u = 0; u < kCamera.width; ++u) {
            const Eigen::Vector3d ray = T.linear() * kCamera.Unproject(u, v, 1);
            double z = 1e9;
            for (int k = 0; k < 3; ++k)
                z = std::min(
                    z, ((ray(k) > 0 ? kHalfRoom(k) : -kHalfRoom(k)) - T.translation()(k)) / ray(k));
            const auto grey =
                static_cast<std::uint8_t>(std::lround(255 * Paint(T.translation() + z * ray)));
            frame.colour(u, v) = {grey, grey, grey};
            frame.depth_m(u, v) = static_cast<float>(z);
        }
    }
    return frame;
}

std::optional<CameraEstimate> Estimate(const PinholeCamera& given, double readout_s = 0) {
    CameraEstimator estimator(given);
    for (int i = 0; i < 36; ++i) estimator.Add(View(i, readout_s));
    return estimator.Estimate();
}

TEST(CameraEstimator, FindsAWrongFocalLength) {
    for (const double factor : {0.95, 1.05}) {
        PinholeCamera given = kCamera;
        given.fx *= factor;
        given.fy *= factor;
        const auto estimate = Estimate(given);
        ASSERT_TRUE(estimate);
        EXPECT_TRUE(estimate->focal_shown());
        EXPECT_FALSE(estimate->centre_shown());
        EXPECT_NEAR(estimate->found.fx, kCamera.fx, 0.002 * kCamera.fx);
        EXPECT_LT(estimate->misfit_found, estimate->misfit_given);
    }
}

TEST(CameraEstimator, FindsAWrongCentre) {
    PinholeCamera given = kCamera;
    given.cx += 8;
    const auto estimate = Estimate(given);
    ASSERT_TRUE(estimate);
    EXPECT_TRUE(estimate->centre_shown());
    EXPECT_NEAR(estimate->found.cx, kCamera.cx, 1);
    EXPECT_NEAR(estimate->found.cy, kCamera.cy, 1);
}

TEST(CameraEstimator, LeavesARightCameraAlone) {
    const auto estimate = Estimate(kCamera);
    ASSERT_TRUE(estimate);
    EXPECT_FALSE(estimate->shown());
    EXPECT_NEAR(estimate->found.fx, kCamera.fx, 0.002 * kCamera.fx);
    EXPECT_NEAR(estimate->readout_s, 0, 0.002);
    EXPECT_FALSE(estimate->shutter_shown(0));
}

TEST(CameraEstimator, IsNotMisledByARollingShutter) {
    const auto estimate = Estimate(kCamera, 0.03);
    ASSERT_TRUE(estimate);
    EXPECT_FALSE(estimate->shown());
    EXPECT_NEAR(estimate->readout_s, 0.03, 0.006);
    EXPECT_TRUE(estimate->shutter_shown(0));
    EXPECT_FALSE(estimate->shutter_shown(estimate->readout_s + 0.001));
}

TEST(CameraEstimator, SaysNothingWithoutATurn) {
    CameraEstimator estimator(kCamera);
    for (int i = 0; i < 20; ++i) estimator.Add(View(0, 0));
    EXPECT_FALSE(estimator.Estimate());
}

TEST(CameraPair, DerivativesAreThoseOfDifferences) {
    const CameraView from = MakeCameraView(View(0, 0)), to = MakeCameraView(View(2, 0));
    const CameraView::Level& seen = to.levels.back();
    CameraPair pair;
    pair.T_to_from = Se3Exp((Vector6d() << 0.01, -0.02, 0.015, 0.02, 0.01, -0.03).finished());
    pair.velocity_from << 0.3, -0.2, 0.1, 0.1, 0.2, 0.05;
    pair.velocity_to << -0.1, 0.4, 0.2, 0.05, -0.1, 0.1;
    const auto value = [&](const CameraViewPoint& point, int unknown, double step) {
        CameraPair moved = pair;
        CameraUnknowns unknowns;
        Eigen::Matrix<double, CameraPairSums::kAll, 1> d =
            Eigen::Matrix<double, CameraPairSums::kAll, 1>::Zero();
        d(unknown) = step;
        moved.T_to_from = Se3Exp(Vector6d(d.head<6>())) * pair.T_to_from;
        moved.gain += d(6);
        moved.offset += d(7);
        unknowns.Add(d.tail<CameraUnknowns::kCount>());
        CameraPairResidual residual;
        EXPECT_TRUE(EvaluatePoint(point, seen, unknowns.Applied(kCamera), moved, unknowns.readout_s,
                                  residual));
        return residual.value;
    };
    constexpr double kStep = 1e-7;
    int compared = 0;
    for (std::size_t i = 0; i < from.levels.back().points.size(); i += 97) {
        const CameraViewPoint& point = from.levels.back().points[i];
        CameraPairResidual residual;
        if (!EvaluatePoint(point, seen, kCamera, pair, 0, residual)) continue;
        for (int k = 0; k < CameraPairSums::kAll; ++k) {
            const double difference =
                (value(point, k, kStep) - value(point, k, -kStep)) / (2 * kStep);
            EXPECT_NEAR(residual.jacobian(k), difference, 1e-4 * (1 + std::abs(difference))) << k;
        }
        ++compared;
    }
    EXPECT_GT(compared, 10);
}

TEST(CameraEstimate, IsBelievedBeyondItsDeviationsAndItsFloorOnly) {
    CameraEstimate estimate;
    estimate.given = estimate.found = kCamera;
    estimate.misfit_given = 2;
    estimate.misfit_found = 1;
    estimate.focal_sigma_px = 0.1;
    estimate.centre_x_sigma_px = estimate.centre_y_sigma_px = 0.1;
    estimate.found.fx *= 1.012;  // below the minimum change
    EXPECT_FALSE(estimate.shown());
    estimate.found.fx = 1.05 * kCamera.fx;
    EXPECT_TRUE(estimate.focal_shown());
    estimate.found.fx = 0.89 * kCamera.fx;  // no calibration is this far off
    estimate.found.cx += 20;                // and this is not to be believed either
    EXPECT_FALSE(estimate.shown());
    estimate.found = kCamera;
    estimate.found.fx = 1.05 * kCamera.fx;
    estimate.focal_sigma_px = 3;  // the change is 4.5 standard deviations
    EXPECT_FALSE(estimate.shown());
    estimate.focal_sigma_px = 2;
    estimate.misfit_found = 2.1;  // a worse fit than before
    EXPECT_FALSE(estimate.shown());
    EXPECT_EQ(EstimateText(estimate, "camera.yaml"),
              "camera.yaml says fx 270.0; this recording says 283.5 +- 2.0");
}

}  // namespace
}  // namespace tessera
