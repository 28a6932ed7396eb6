// The preset diaz2018 solves [D18] eq. 25: its normal equations against a slow, literal second
// implementation.
#include <gtest/gtest.h>

#include "system/paper_energy.h"

namespace tessera {
namespace {

using namespace testing_support;

struct FirstFineIcpSums : CpuIcpSums {
    int fine_width = 0;
    std::optional<PoseSums> sums;
    IcpArguments arguments{};

    PoseSums Sum(const IcpArguments& a, int points) override {
        const PoseSums now = CpuIcpSums::Sum(a, points);
        if (!sums && a.width == fine_width) sums = now, arguments = a;
        return now;
    }
};

// Keeps the view that it predicted.
struct RememberedView : ViewPredictor {
    RayCaster caster;
    PredictedView view;

    void Predict(const BlockMap& map, const PinholeCamera& camera,
                 const Eigen::Isometry3d& T_world_camera, float min_depth_m, float max_depth_m,
                 PredictedView& out) override {
        caster.Predict(map, camera, T_world_camera, min_depth_m, max_depth_m, out);
        view = out;
    }
};

TEST(Diaz2018, SolvesTheNormalEquationsOfEquation25) {
    const PresetMap world("diaz2018");
    const TrackersConfig& trackers = world.config.pipeline.trackers;
    FirstFineIcpSums ours;
    ours.fine_width = world.camera.width;
    ResidualModel model(trackers.photometric);
    auto caster = std::make_unique<RememberedView>();
    const PredictedView* const seen = &caster->view;
    IcpTracker tracker(trackers.icp, world.camera, TrackJudge(trackers.judge), model, false,
                       std::move(caster), &ours);
    EXPECT_EQ(tracker.Track(world.Input()).status, TrackStatus::kGood);
    ASSERT_TRUE(ours.sums);

    // The view that the model predicts, and the pose in its frame.
    const PredictedView& view = *seen;
    Eigen::Isometry3d T_view_camera = Eigen::Isometry3d::Identity();
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            T_view_camera.linear()(i, j) = ours.arguments.rotation[3 * i + j];
        T_view_camera.translation()(i) = ours.arguments.translation[i];
    }
    const PinholeCamera& k = world.camera;
    const auto measured = [&](int u, int v) {
        const float z = world.frame.depth_m(u, v);
        return z >= world.config.pipeline.frame.min_depth_m &&
                       z <= world.config.pipeline.frame.max_depth_m
                   ? double(z)
                   : 0.0;
    };
    const auto vertex = [&](double z, double u, double v) {  // eq. 14
        return Eigen::Vector3d((u - k.cx) / k.fx * z, (v - k.cy) / k.fy * z, z);
    };
    Normal slow;
    int matched = 0;
    for (int v = 0; v + 1 < k.height; ++v)
        for (int u = 0; u + 1 < k.width; ++u) {
            const double z = measured(u, v), right = measured(u + 1, v), down = measured(u, v + 1);
            // Surfaces end where the next pixel's depth differs by more than 3 %.
            if (z <= 0 || right <= 0 || down <= 0 || std::abs(right - z) >= 0.03 * z ||
                std::abs(down - z) >= 0.03 * z)
                continue;
            const Eigen::Vector3d V = vertex(z, u, v);
            // eq. 15, turned towards the camera.
            const Eigen::Vector3d n =
                (vertex(down, u, v + 1) - V).cross(vertex(right, u + 1, v) - V).normalized();
            const Eigen::Vector3d p = T_view_camera * V;
            const double column = p.x() / p.z() * k.fx + k.cx,  // eq. 18
                line = p.y() / p.z() * k.fy + k.cy;
            // The view ends at the centres of its outermost pixels.
            if (column < 0 || line < 0 || column > k.width - 1 || line > k.height - 1) continue;
            const int a = int(std::floor(column + 0.5)), b = int(std::floor(line + 0.5));
            if (view.depth_m(a, b) <= 0) continue;
            const Eigen::Vector3d model_vertex = vertex(view.depth_m(a, b), a, b),
                                  model_normal = view.normal_camera(a, b).cast<double>();
            if ((p - model_vertex).norm() > trackers.icp.distance_gate_m ||
                (T_view_camera.linear() * n).dot(model_normal) <
                    std::cos(trackers.icp.normal_gate_rad))
                continue;
            ++matched;
            Vector6d A;  // eq. 27
            A << p.cross(model_normal), model_normal;
            slow.Add(A, (p - model_vertex).dot(model_normal), 1.0);  // minus eq. 28
        }
    EXPECT_GT(matched, 8000);
    EXPECT_NEAR((*ours.sums)[SumLayout::kDistanceWeight], matched, 2);
    ExpectEqual(DistanceTerm(*ours.sums), slow);
}

}  // namespace
}  // namespace tessera
