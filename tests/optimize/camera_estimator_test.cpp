// A painted room, seen by a camera whose given intrinsics may be wrong.
#include "optimize/camera_estimator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "optimize/camera_pair.h"
#include "optimize/painted_room.h"

namespace tessera {
namespace {

using painted_room::kCamera;
using painted_room::View;

std::optional<CameraEstimate> Estimate(const PinholeCamera& given, double readout_s = 0,
                                       double vignetting = 0) {
    CameraEstimator estimator(given);
    for (int i = 0; i < 36; ++i) estimator.Add(View(i, readout_s, vignetting));
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
    EXPECT_NEAR(estimate->vignetting, 0, 0.005);
    EXPECT_FALSE(estimate->vignetting_shown());
}

TEST(CameraEstimator, FindsDarkCornersAndIsNotMisledByThem) {
    for (const double vignetting : {0.25, -0.1}) {
        const auto estimate = Estimate(kCamera, 0, vignetting);
        ASSERT_TRUE(estimate);
        EXPECT_NEAR(estimate->vignetting, vignetting, 0.01);
        EXPECT_TRUE(estimate->vignetting_shown());
        EXPECT_FALSE(estimate->shown());
        EXPECT_NEAR(estimate->found.fx, kCamera.fx, 0.004 * kCamera.fx);
        EXPECT_FALSE(estimate->shutter_shown(0));
    }
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
    CameraUnknowns start;
    start.vignetting = 0.2;
    const auto value = [&](const CameraViewPoint& point, int unknown, double step) {
        CameraPair moved = pair;
        CameraUnknowns unknowns = start;
        Eigen::Matrix<double, CameraPairSums::kAll, 1> d =
            Eigen::Matrix<double, CameraPairSums::kAll, 1>::Zero();
        d(unknown) = step;
        moved.T_to_from = Se3Exp(Vector6d(d.head<6>())) * pair.T_to_from;
        moved.gain += d(6);
        moved.offset += d(7);
        unknowns.Add(d.tail<CameraUnknowns::kCount>());
        CameraPairResidual residual;
        EXPECT_TRUE(
            EvaluatePoint(point, seen, unknowns.Applied(kCamera), moved, unknowns, residual));
        return residual.value;
    };
    constexpr double kStep = 1e-7;
    int compared = 0;
    for (std::size_t i = 0; i < from.levels.back().points.size(); i += 97) {
        const CameraViewPoint& point = from.levels.back().points[i];
        CameraPairResidual residual;
        if (!EvaluatePoint(point, seen, start.Applied(kCamera), pair, start, residual)) continue;
        for (int k = 0; k < CameraPairSums::kAll; ++k) {
            const double difference =
                (value(point, k, kStep) - value(point, k, -kStep)) / (2 * kStep);
            EXPECT_NEAR(residual.jacobian(k), difference, 1e-4 * (1 + std::abs(difference))) << k;
        }
        ++compared;
    }
    EXPECT_GT(compared, 10);
}

TEST(CameraEstimate, BelievesInVignettingThatACameraCanHave) {
    CameraEstimate estimate;
    estimate.vignetting_sigma = 0.01;
    for (const auto& [share, believed] :
         {std::pair(0.05, false), {0.07, true}, {0.72, false}, {-0.1, true}, {-0.35, false}}) {
        estimate.vignetting = share;
        EXPECT_EQ(estimate.vignetting_shown(), believed) << share;
    }
    estimate.vignetting_sigma = 0.001;
    estimate.vignetting = 0.02;
    EXPECT_FALSE(estimate.vignetting_shown());
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
    EXPECT_TRUE(estimate.plausible());
    estimate.found.fx = 1.05 * kCamera.fx;
    EXPECT_TRUE(estimate.focal_shown());
    estimate.found.fx = 0.89 * kCamera.fx;  // no calibration is this far off
    estimate.found.cx += 20;                // and this is not to be believed either
    EXPECT_FALSE(estimate.shown());
    EXPECT_FALSE(estimate.plausible());
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

TEST(CameraEstimate, ACentreIsBelievedBeyondTwelveDeviations) {
    CameraEstimate estimate;
    estimate.given = estimate.found = kCamera;
    estimate.misfit_given = 2;
    estimate.misfit_found = 1;
    for (const double side : {-1.0, 1.0}) {
        estimate.found.cx = kCamera.cx + 8 * side;
        for (const auto& [sigma_px, shown] : {std::pair(0.7, false), {0.6, true}}) {
            estimate.centre_x_sigma_px = sigma_px;
            EXPECT_EQ(estimate.centre_shown(), shown) << side << ' ' << sigma_px;
        }
    }
}

TEST(CameraEstimate, ItsReadOutIsCertainWhereItShowsOrIsClearlySmall) {
    CameraEstimate estimate;
    EXPECT_FALSE(estimate.certain_readout_s(0));  // no deviation: nothing was estimated
    EXPECT_EQ(estimate.certain_readout_s(0.03), 0.03);
    estimate.readout_s = 0.028;
    estimate.readout_sigma_s = 0.001;
    EXPECT_EQ(estimate.certain_readout_s(0), 0.028);
    EXPECT_EQ(estimate.certain_readout_s(0.02), 0.028);
    EXPECT_EQ(estimate.certain_readout_s(0.03), 0.03);  // not shown to be wrong
    estimate.readout_sigma_s = 0.005;
    EXPECT_FALSE(estimate.certain_readout_s(0));
    estimate.readout_s = 0.001;
    EXPECT_FALSE(estimate.certain_readout_s(0));
    estimate.readout_sigma_s = 0.0015;
    EXPECT_EQ(estimate.certain_readout_s(0), 0);
}

}  // namespace
}  // namespace tessera
