// Shared by the rasteriser tests: cameras, a painted scene without symmetry, and the rasteriser
// itself. Without a rasteriser the tests skip.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "mapping/analytic_fields.h"
#include "mapping/ray_caster.h"
#include "render/mesh_rasteriser.h"

namespace tessera::testing_support {

inline PinholeCamera SmallCamera() { return {160, 120, 140, 145, 79.5, 60.5}; }

inline Eigen::Isometry3d LookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
                                double roll_rad = .3) {
    Eigen::Matrix3d R;
    R.col(2) = (target - eye).normalized();
    R.col(0) = Eigen::Vector3d(.1, 1, .2).cross(R.col(2)).normalized();
    R.col(1) = R.col(2).cross(R.col(0));
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = R * Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    T.translation() = eye;
    return T;
}

inline int CountHits(const PredictedView& view) {
    return static_cast<int>(std::count_if(view.depth_m.data(),
                                          view.depth_m.data() + view.depth_m.size(),
                                          [](float z) { return z > 0; }));
}

inline bool SameBytes(const PredictedView& a, const PredictedView& b) {
    return a.depth_m == b.depth_m && a.normal_camera == b.normal_camera && a.colour == b.colour &&
           a.intensity == b.intensity;
}

class MeshRasteriserTest : public ::testing::Test {
  protected:
    void SetUp() override {
        rasteriser_ = Make();
        if (!rasteriser_) GTEST_SKIP() << why_;
    }
    std::unique_ptr<MeshRasteriser> Make() {
        auto made = MeshRasteriser::Create({});
        if (made.ok()) return std::move(made.value());
        why_ = made.message();
        return nullptr;
    }
    PredictedView Draw(const BlockMap& map, const PinholeCamera& camera, const Eigen::Isometry3d& T,
                       float min_depth_m = .1f, float max_depth_m = 5.f) {
        PredictedView view;
        rasteriser_->Predict(map, camera, T, min_depth_m, max_depth_m, view);
        EXPECT_TRUE(rasteriser_->status().ok()) << rasteriser_->status().message();
        return view;
    }

    std::unique_ptr<MeshRasteriser> rasteriser_;
    std::string why_;
};

inline PredictedView Cast(const BlockMap& map, const PinholeCamera& camera,
                          const Eigen::Isometry3d& T, float min_depth_m = .1f,
                          float max_depth_m = 5.f) {
    PredictedView view;
    RayCaster().Predict(map, camera, T, min_depth_m, max_depth_m, view);
    return view;
}

inline double SceneDistance(const Eigen::Vector3d& p) {
    static const Sdf kTorus = Torus({.3, -.1, 0}, .2, .07), kBall = Sphere({-.25, .2, .1}, .2);
    return std::min({kTorus(p), kBall(p), .35 + .02 * std::sin(8 * p.x()) - p.z()});
}

// A painted scene without any symmetry.
inline void FillScene(BlockMap& map, std::uint32_t revision = 1) {
    Fill(
        map, SceneDistance, {-9, -9, -4}, {8, 8, 5},
        [](const Eigen::Vector3d& p) {
            return Eigen::Vector3d(.5 + .4 * p.x(), .5 - .4 * p.y(),
                                   .5 + .3 * std::sin(20 * p.x() + 9 * p.y()));
        },
        revision);
}

}  // namespace tessera::testing_support
