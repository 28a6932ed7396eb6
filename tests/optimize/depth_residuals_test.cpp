#include "optimize/depth_residuals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "optimize/camera_view.h"
#include "optimize/painted_room.h"

namespace tessera {
namespace {

using painted_room::kCamera;
using painted_room::View;

constexpr double kGate = 1e4;

struct TwoViews {
    DepthView from = MakeDepthView(View(3, 0).depth_m, kCamera),
              to = MakeDepthView(View(9, 0).depth_m, kCamera);
    PinholeCamera camera = Averaged(kCamera, from.reduction);
    DistortionNodes nodes;

    std::vector<DepthResidual> At(const Eigen::Isometry3d& T_to_from) const {
        std::vector<DepthResidual> residuals;
        FindDepthResiduals(from, to, camera, T_to_from, nodes, kGate, residuals);
        return residuals;
    }
};

// The surfaces are so far apart that the deviation's dependence counts.
TEST(DepthResiduals, DerivativesByTheNodesAreCentralDifferences) {
    TwoViews views;
    Vector6d apart;
    apart << 0.02, -0.03, 0.01, 0.03, 0.02, 0.04;
    const Eigen::Isometry3d T = Se3Exp(apart);
    for (int n = 0; n < DistortionNodes::kCount; ++n) views.nodes.per_m(n) = 0.003 * std::sin(n);
    const std::vector<DepthResidual> at = views.At(T);
    ASSERT_GT(at.size(), 500u);
    constexpr double kStep = 1e-6;
    int compared = 0;
    for (int n = 0; n < DistortionNodes::kCount; n += 7) {
        const double before = views.nodes.per_m(n);
        views.nodes.per_m(n) = before + kStep;
        const std::vector<DepthResidual> more = views.At(T);
        views.nodes.per_m(n) = before - kStep;
        const std::vector<DepthResidual> less = views.At(T);
        views.nodes.per_m(n) = before;
        if (more.size() != at.size() || less.size() != at.size()) continue;  // one at an edge
        for (std::size_t i = 0; i < at.size(); ++i) {
            double derivative = 0;
            for (int k = 0; k < 8; ++k)
                if (at[i].nodes[k] == n) derivative += at[i].to_nodes[k];
            const double difference = (more[i].value - less[i].value) / (2 * kStep);
            if (std::abs(difference) > 1e5) continue;  // it met another pixel
            EXPECT_NEAR(derivative, difference, 1e-3 * std::abs(difference) + 1e-2);
            if (derivative != 0) ++compared;
        }
    }
    EXPECT_GT(compared, 200);
}

// Where the surfaces meet, so that the deviation does not count.
TEST(DepthResiduals, DerivativesByTheMotionAreCentralDifferences) {
    TwoViews views;
    views.to = views.from;
    constexpr double kStep = 1e-7;
    const std::vector<DepthResidual> at = views.At(Eigen::Isometry3d::Identity());
    ASSERT_GT(at.size(), 1000u);
    for (int axis = 0; axis < 6; ++axis) {
        const Vector6d step = kStep * Vector6d::Unit(axis);
        const std::vector<DepthResidual> more = views.At(Se3Exp(step)),
                                         less = views.At(Se3Exp(-step));
        ASSERT_EQ(more.size(), at.size());
        ASSERT_EQ(less.size(), at.size());
        for (std::size_t i = 0; i < at.size(); ++i)
            EXPECT_NEAR(at[i].to_motion(axis), (more[i].value - less[i].value) / (2 * kStep),
                        1e-3 * at[i].to_motion.norm());
    }
}

}  // namespace
}  // namespace tessera
