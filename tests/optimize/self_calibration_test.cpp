// A box-shaped room with pillars, seen without noise by a rotating camera whose given calibration
// may be wrong.
#include "optimize/self_calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/se3.h"

namespace tessera {
namespace {

const PinholeCamera kCamera{320, 240, 262.5, 262.5, 159.5, 119.5};

struct Box {
    Eigen::Vector3d low, high;
};
const Box kRoom{{-1.8, -1.2, -2.0}, {2.2, 1.4, 2.6}};
const Box kPillars[] = {{{-0.9, -1.2, 1.4}, {-0.5, 0.3, 1.8}},
                        {{0.9, 0.2, 0.9}, {1.5, 1.4, 1.5}},
                        {{-1.4, 0.4, -0.8}, {-0.9, 1.4, 0.2}}};

// Distances along a ray to the point where it leaves a box and to the point where it enters one
// (infinity if it misses).
double Leaves(const Box& box, const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
    double t = 1e9;
    for (int k = 0; k < 3; ++k)
        t = std::min(t, ((ray(k) > 0 ? box.high(k) : box.low(k)) - from(k)) / ray(k));
    return t;
}
double Enters(const Box& box, const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
    double in = 0, out = 1e9;
    for (int k = 0; k < 3; ++k) {
        in = std::max(in, ((ray(k) > 0 ? box.low(k) : box.high(k)) - from(k)) / ray(k));
        out = std::min(out, ((ray(k) > 0 ? box.high(k) : box.low(k)) - from(k)) / ray(k));
    }
    return in < out && in > 0 ? in : 1e9;
}

class SelfCalibration : public testing::Test {
  protected:
    // Takes the true depth and the image position (tangents), and returns the measured depth.
    using Sensor = std::function<double(double z, double x, double y)>;
    static constexpr int kViews = 18;

    void SetUp() override {
        if (!PoseGraphAvailable()) GTEST_SKIP() << "this build has no Ceres: install libceres-dev";
        for (int i = 0; i < kViews; ++i) {
            const double a = 0.25 * i;
            const Eigen::Isometry3d T(
                Eigen::Translation3d(0.3 * std::cos(1.3 * a), 0.2 * std::sin(a),
                                     0.3 * std::sin(1.7 * a)) *
                Eigen::AngleAxisd(a, Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(0.35 * std::sin(2 * a), Eigen::Vector3d::UnitX()));
            poses.push_back(T);
            for (int before : {i - 1, i - 2})
                if (before >= 0)
                    edges.push_back({before, i, Eigen::Isometry3d::Identity(),
                                     RootInformation(0.01, 0.01), false});
        }
        truth = poses;
        for (PoseEdge& edge : edges)
            edge.T_from_to = Normalised(poses[static_cast<std::size_t>(edge.from)].inverse() *
                                        poses[static_cast<std::size_t>(edge.to)]);
    }
    std::vector<CalibrationView> Views(const PinholeCamera& camera, const Sensor& sensor) const {
        std::vector<CalibrationView> views;
        for (const Eigen::Isometry3d& T : truth) {
            DepthImage depth_m(camera.width, camera.height);
            for (int v = 0; v < camera.height; ++v)
                for (int u = 0; u < camera.width; ++u) {
                    const Eigen::Vector3d ray = camera.Unproject(u, v, 1), from = T.translation(),
                                          to = T.linear() * ray;
                    double z = Leaves(kRoom, from, to);
                    for (const Box& pillar : kPillars) z = std::min(z, Enters(pillar, from, to));
                    depth_m(u, v) = static_cast<float>(sensor(z, ray.x(), ray.y()));
                }
            views.emplace_back(depth_m);
        }
        return views;
    }
    static double Exact(double z, double, double) { return z; }

    std::vector<Eigen::Isometry3d> truth, poses;
    std::vector<PoseEdge> edges;
};

TEST_F(SelfCalibration, FindsAFocalLengthThatIsOff) {
    const auto report =
        RefineCalibration(Corrected(kCamera, {1 / 1.02, 0}), Views(kCamera, Exact), edges, poses);
    ASSERT_TRUE(report.ok()) << report.message();
    const CalibrationReport& r = report.value();
    EXPECT_TRUE(r.shown);
    EXPECT_NEAR(r.calibration.focal_scale, 1.02, 3 * r.focal_sigma);
    EXPECT_NEAR(r.calibration.focal_scale, 1.02, 0.002);
    EXPECT_EQ(r.calibration.disparity_offset_per_m, 0);
    EXPECT_LT(r.rms_after_m, 0.5 * r.rms_before_m);
    for (std::size_t i = 0; i < poses.size(); ++i)
        EXPECT_LT((poses[i].translation() - truth[i].translation()).norm(), 0.02) << i;
}

TEST_F(SelfCalibration, FindsBothFocalLengthAndDisparityOffset) {
    const Sensor sensor = [](double z, double, double) { return z / (1 - 0.012 * z); };
    const auto report =
        RefineCalibration(Corrected(kCamera, {1.03, 0}), Views(kCamera, sensor), edges, poses);
    ASSERT_TRUE(report.ok()) << report.message();
    const CalibrationReport& r = report.value();
    EXPECT_TRUE(r.shown);
    EXPECT_NEAR(r.calibration.focal_scale, 1 / 1.03, 3 * r.focal_sigma + 0.001);
    EXPECT_NEAR(r.calibration.disparity_offset_per_m, 0.012, 3 * r.offset_sigma_per_m + 0.0005);
    const std::string text = CalibrationText(Corrected(kCamera, {1.03, 0}), -0.002, r);
    EXPECT_NE(text.find("focal length 270.4 -> 26"), std::string::npos) << text;
    EXPECT_NE(text.find("disparity_offset_per_m -0.0020 -> 0.0"), std::string::npos) << text;
}

TEST_F(SelfCalibration, LeavesAGoodOneAndThePosesAlone) {
    const auto report = RefineCalibration(kCamera, Views(kCamera, Exact), edges, poses);
    ASSERT_TRUE(report.ok()) << report.message();
    EXPECT_FALSE(report.value().shown);
    EXPECT_NEAR(report.value().calibration.focal_scale, 1, 0.001);
    for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_EQ(poses[i].matrix(), truth[i].matrix());
    EXPECT_NE(CalibrationText(kCamera, 0, report.value()).find("keeping the given values"),
              std::string::npos);
}

// The sensor has a distortion that the model cannot represent. A model with only a focal length
// would report a small uncertainty.
TEST_F(SelfCalibration, IsNotMisledByAnErrorOfAnotherKind) {
    const Sensor sensor = [](double z, double x, double y) {
        return z * (1 + 0.012 * std::sin(4 * x) + 0.012 * std::sin(3 * y + z));
    };
    const auto report = RefineCalibration(kCamera, Views(kCamera, sensor), edges, poses);
    ASSERT_TRUE(report.ok()) << report.message();
    EXPECT_FALSE(report.value().shown) << CalibrationText(kCamera, 0, report.value());
}

// A bare wall looks the same under every calibration.
TEST_F(SelfCalibration, AWallAloneDoesNotShowIt) {
    const PinholeCamera off = Corrected(kCamera, {1.03, 0});
    std::vector<CalibrationView> views;
    for (int i = 0; i < kViews; ++i) {
        DepthImage depth_m(kCamera.width, kCamera.height);
        std::fill_n(depth_m.data(), depth_m.size(), 1.5f + 0.01f * static_cast<float>(i));
        views.emplace_back(depth_m);
        poses[static_cast<std::size_t>(i)] =
            Eigen::Translation3d(0.02 * i, 0, -0.01 * i) * Eigen::Isometry3d::Identity();
    }
    for (PoseEdge& edge : edges)
        edge.T_from_to = poses[static_cast<std::size_t>(edge.from)].inverse() *
                         poses[static_cast<std::size_t>(edge.to)];
    const auto report = RefineCalibration(off, views, edges, poses);
    ASSERT_FALSE(report.ok());
    EXPECT_NE(report.message().find("too little was seen from two places"), std::string::npos);
}

TEST_F(SelfCalibration, ASingleViewIsAnError) {
    EXPECT_FALSE(RefineCalibration(kCamera, {Views(kCamera, Exact).front()}, {}, poses).ok());
}

}  // namespace
}  // namespace tessera
