#include "render/mesh_rasteriser.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "render/rasteriser_fixture.h"

namespace tessera {
namespace {

using namespace testing_support;

constexpr double kVoxel_m = .01;

double Median(std::vector<double> values) {
    std::nth_element(values.begin(),
                     values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values.at(values.size() / 2);
}

// Marching cubes reproduces a plane exactly, so every pixel must be exact for any intrinsics.
TEST_F(MeshRasteriserTest, ObliquePlaneIsExact) {
    const Eigen::Vector3d normal = Eigen::Vector3d(.3, -.2, -1).normalized();
    BlockMap map{BlockMap::Config{}};
    Fill(map, Plane(normal, .013), {-14, -14, -8}, {13, 13, 7});
    const Eigen::Isometry3d T = LookAt({.2, .1, -.9}, {-.1, .05, 0});
    for (const PinholeCamera& camera :
         {SmallCamera(), PinholeCamera{160, 120, 170, 110, 31.25, 98.75},
          PinholeCamera{33, 57, 40, 40, 16, 28}}) {
        const PredictedView view = Draw(map, camera, T, .1f, 3.f);
        EXPECT_EQ(view.camera, camera);
        int compared = 0;
        for (int v = 0; v < camera.height; ++v)
            for (int u = 0; u < camera.width; ++u) {
                const Eigen::Vector3d ray = T.linear() * camera.Unproject(u, v, 1);
                const double z = (.013 - normal.dot(T.translation())) / normal.dot(ray);
                if (z < .1 || z > 3 || (T.translation() + z * ray).cwiseAbs().maxCoeff() > .9)
                    continue;
                ++compared;
                ASSERT_NEAR(view.depth_m(u, v), z, 5e-5 / std::abs(normal.dot(ray.normalized())))
                    << u << " " << v;
                ASSERT_LT((T.linear() * view.normal_camera(u, v).cast<double>() - normal).norm(),
                          2e-3);
                ASSERT_NEAR(view.normal_camera(u, v).norm(), 1, 1e-5);
            }
        EXPECT_GT(compared, camera.width * camera.height / 2);
    }
}

// Whether the ray-cast depth is smooth around the pixel.
bool IsInside(const PredictedView& view, int u, int v) {
    const float z = view.depth_m(u, v);
    for (int dv = -2; dv <= 2; ++dv)
        for (int du = -2; du <= 2; ++du) {
            if (!view.depth_m.Contains(u + du, v + dv)) return false;
            if (std::abs(view.depth_m(u + du, v + dv) - z) > .03f) return false;
        }
    return z > 0;
}

TEST_F(MeshRasteriserTest, AgreesWithTheRayCaster) {
    BlockMap map{BlockMap::Config{}};
    FillScene(map);
    const PinholeCamera camera{320, 240, 270, 290, 150.25, 131};
    for (const Eigen::Vector3d& eye :
         {Eigen::Vector3d(.1, .2, -1), Eigen::Vector3d(.7, -.6, -.5)}) {
        const Eigen::Isometry3d T = LookAt(eye, {0, 0, .2});
        const PredictedView drawn = Draw(map, camera, T), cast = Cast(map, camera, T);
        std::vector<double> depth_m, angle_deg, red, intensity;
        int missed = 0;
        for (int v = 0; v < camera.height; ++v)
            for (int u = 0; u < camera.width; ++u) {
                if (!IsInside(cast, u, v)) continue;
                missed += drawn.depth_m(u, v) == 0;
                depth_m.push_back(std::abs(drawn.depth_m(u, v) - cast.depth_m(u, v)));
                const float cosine = drawn.normal_camera(u, v).dot(cast.normal_camera(u, v));
                angle_deg.push_back(std::acos(std::min(1.0f, cosine)) * 57.29578f);
                red.push_back(std::abs(drawn.colour(u, v).r - cast.colour(u, v).r));
                intensity.push_back(std::abs(drawn.intensity(u, v) - cast.intensity(u, v)));
            }
        ASSERT_GT(depth_m.size(), 30000u);
        EXPECT_EQ(missed, 0);
        EXPECT_LT(Median(depth_m), kVoxel_m / 40);
        EXPECT_LT(Median(angle_deg), 1);
        EXPECT_LT(Median(red), 1.5);
        EXPECT_LT(Median(intensity), 2e-3);
        const auto share_over = [](const std::vector<double>& values, double limit) {
            return static_cast<double>(std::count_if(values.begin(), values.end(),
                                                     [&](double x) { return x > limit; })) /
                   static_cast<double>(values.size());
        };
        EXPECT_LT(share_over(depth_m, kVoxel_m / 4), .01);
        EXPECT_LT(share_over(angle_deg, 5), .02);
        EXPECT_LT(share_over(red, 3), .01);
        EXPECT_LT(share_over(intensity, .01), .01);
    }
}

TEST_F(MeshRasteriserTest, RowsAndColumnsLieWhereTheImagesDo) {
    BlockMap map{BlockMap::Config{}};
    Fill(map, Sphere({.3, -.2, 0}, .1), {-9, -9, -4}, {8, 8, 5});
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation().z() = -1;
    const PredictedView view = Draw(map, SmallCamera(), T);
    double u_sum = 0, v_sum = 0;
    for (int v = 0; v < view.camera.height; ++v)
        for (int u = 0; u < view.camera.width; ++u)
            if (view.depth_m(u, v) > 0) {
                u_sum += u;
                v_sum += v;
            }
    const int hits = CountHits(view);
    ASSERT_GT(hits, 400);
    EXPECT_NEAR(u_sum / hits, 79.5 + .3 * 140, .8);  // right of the centre
    EXPECT_NEAR(v_sum / hits, 60.5 - .2 * 145, .8);  // above the centre
    // The left side of the sphere faces left and its top faces up.
    EXPECT_LT(view.normal_camera(111, 31).x(), -.4f);
    EXPECT_LT(view.normal_camera(121, 21).y(), -.4f);
}

TEST_F(MeshRasteriserTest, SurfaceWithoutColourSaysSo) {
    BlockMap map{BlockMap::Config{}};
    Fill(map, Sphere({0, 0, 0}, .3), {-6, -6, -6}, {5, 5, 5});
    const PredictedView view = Draw(map, SmallCamera(), LookAt({0, 0, -1}, {0, 0, 0}));
    ASSERT_GT(view.depth_m(80, 60), 0);
    EXPECT_EQ(view.intensity(80, 60), -1);
    EXPECT_EQ(view.colour(80, 60), (Rgb8{128, 128, 128}));
}

TEST_F(MeshRasteriserTest, NothingToSee) {
    BlockMap map{BlockMap::Config{}};
    const PinholeCamera camera = SmallCamera();
    EXPECT_EQ(CountHits(Draw(map, camera, LookAt({0, 0, -1}, {0, 0, 0}))), 0);
    Fill(map, Sphere({0, 0, 0}, .3), {-6, -6, -6}, {5, 5, 5});
    EXPECT_GT(CountHits(Draw(map, camera, LookAt({0, 0, -1}, {0, 0, 0}))), 3000);
    // Looks away from the surface.
    for (const PredictedView& view : {Draw(map, camera, LookAt({0, 0, -1}, {0, 0, -2})),
                                      // Beyond the maximum depth.
                                      Draw(map, camera, LookAt({0, 0, -1}, {0, 0, 0}), .1f, .6f),
                                      // Sees the back of the surface.
                                      Draw(map, camera, LookAt({0, 0, 0}, {0, 0, 1}))}) {
        EXPECT_EQ(CountHits(view), 0);
        for (std::size_t i = 0; i < view.depth_m.size(); ++i) {
            ASSERT_EQ(view.normal_camera.data()[i].norm(), 0);
            ASSERT_EQ(view.intensity.data()[i], 0);
            ASSERT_EQ(view.colour.data()[i], Rgb8{});
        }
    }
}

TEST_F(MeshRasteriserTest, FarFromTheWorldsOrigin) {
    const Eigen::Vector3d normal = Eigen::Vector3d(.1, -.2, -1).normalized(),
                          middle(400.003, -250.002, 123.001);
    BlockMap map{BlockMap::Config{}};
    const Eigen::Vector3i block = (middle / .08).array().floor().cast<int>();
    Fill(map, Plane(normal, normal.dot(middle)), {block.x() - 6, block.y() - 6, block.z() - 4},
         {block.x() + 6, block.y() + 6, block.z() + 4});
    const Eigen::Isometry3d T = LookAt(middle + Eigen::Vector3d(0, .1, -.8), middle, 0);
    const PredictedView view = Draw(map, SmallCamera(), T, .1f, 3.f);
    for (int v = 40; v < 80; ++v)
        for (int u = 60; u < 100; ++u) {
            const Eigen::Vector3d ray = T.linear() * SmallCamera().Unproject(u, v, 1);
            ASSERT_NEAR(view.depth_m(u, v), normal.dot(middle - T.translation()) / normal.dot(ray),
                        4e-5);
        }
}

}  // namespace
}  // namespace tessera
