#include "mapping/ray_caster.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mapping/analytic_fields.h"

namespace tessera {
namespace {

using namespace testing_support;

// Voxels are 1 cm, so a tenth of a voxel is 1 mm.
constexpr double kTenthVoxel = 1e-3;

PinholeCamera SmallCamera() { return {160, 120, 140, 145, 79.5, 60.5}; }

// A camera at `eye` that looks at `target`, rolled about the optical axis.
Eigen::Isometry3d LookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
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

PredictedView Cast(const BlockMap& map, const PinholeCamera& camera,
                   const Eigen::Isometry3d& T_world_camera, float min_depth_m, float max_depth_m) {
    PredictedView view;
    RayCaster().Predict(map, camera, T_world_camera, min_depth_m, max_depth_m, view);
    return view;
}

int CountHits(const PredictedView& view) {
    int hits = 0;
    for (std::size_t i = 0; i < view.depth_m.size(); ++i) hits += view.depth_m.data()[i] > 0;
    return hits;
}

// Depth along z at which the ray of the pixel meets the sphere, 0 if it misses. Also returns the
// cosine of the angle of incidence.
double SphereDepth(const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera, int u,
                   int v, const Eigen::Vector3d& centre, double radius, double* cosine) {
    const Eigen::Vector3d ray = camera.Unproject(u, v, 1), c = T_world_camera.inverse() * centre;
    const double a = ray.squaredNorm(), b = ray.dot(c),
                 discriminant = b * b - a * (c.squaredNorm() - radius * radius);
    if (discriminant < 0) return 0;
    const double z = (b - std::sqrt(discriminant)) / a;
    *cosine = (c - z * ray).normalized().dot(ray.normalized());
    return z;
}

TEST(RayCaster, SphereFromAllSides) {
    const Eigen::Vector3d centre(-.0311, .0202, -.0103);
    BlockMap map{BlockMap::Config{}};
    Fill(map, Sphere(centre, .3), {-6, -6, -6}, {5, 5, 5});
    const PinholeCamera camera = SmallCamera();
    for (const Eigen::Vector3d& eye :
         {Eigen::Vector3d(1, .1, .2), Eigen::Vector3d(-.2, -1, .3), Eigen::Vector3d(.1, .2, -.9),
          Eigen::Vector3d(-.7, .6, .7)}) {
        const Eigen::Isometry3d T = LookAt(eye, centre);
        const PredictedView view = Cast(map, camera, T, .1f, 5.f);
        int missed = 0, compared = 0;
        for (int v = 0; v < camera.height; ++v)
            for (int u = 0; u < camera.width; ++u) {
                double cosine = 0;
                const double z = SphereDepth(camera, T, u, v, centre, .3, &cosine);
                if (z == 0 || cosine < .2) continue;
                ++compared;
                missed += view.depth_m(u, v) == 0;
                if (view.depth_m(u, v) == 0) continue;
                ASSERT_NEAR(view.depth_m(u, v), z, kTenthVoxel) << u << " " << v;
                const Eigen::Vector3d normal =
                    (camera.Unproject(u, v, z) - T.inverse() * centre).normalized();
                ASSERT_GT(view.normal_camera(u, v).cast<double>().dot(normal), .998);
            }
        EXPECT_GT(compared, 3000);
        EXPECT_EQ(missed, 0);
        double cosine;
        for (int v = 0; v < camera.height; ++v)
            for (int u = 0; u < camera.width; ++u)
                if (SphereDepth(camera, T, u, v, centre, .301, &cosine) == 0) {
                    ASSERT_EQ(view.depth_m(u, v), 0) << u << " " << v;
                }
    }
}

// The distance field of a plane is linear, so interpolation is exact. Every pixel must be exact
// too, across blocks and at grazing angles.
TEST(RayCaster, ObliquePlaneIsExact) {
    const Eigen::Vector3d normal = Eigen::Vector3d(.3, -.2, -1).normalized();
    BlockMap map{BlockMap::Config{}};
    Fill(map, Plane(normal, .013), {-14, -14, -8}, {13, 13, 7});
    const PinholeCamera camera = SmallCamera();
    for (const Eigen::Vector3d& eye : {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(.6, .1, -.3)}) {
        const Eigen::Isometry3d T = LookAt(eye, Eigen::Vector3d(-.1, .05, 0));
        const PredictedView view = Cast(map, camera, T, .1f, 3.f);
        int compared = 0;
        for (int v = 0; v < camera.height; ++v)
            for (int u = 0; u < camera.width; ++u) {
                const Eigen::Vector3d ray = T.linear() * camera.Unproject(u, v, 1);
                const double z = (.013 - normal.dot(eye)) / normal.dot(ray);
                if (z < .1 || z > 3 || (eye + z * ray).cwiseAbs().maxCoeff() > .9) continue;
                ++compared;
                ASSERT_NEAR(view.depth_m(u, v), z, 5e-5 / std::abs(normal.dot(ray.normalized())));
                ASSERT_LT((T.linear() * view.normal_camera(u, v).cast<double>() - normal).norm(),
                          2e-3);
            }
        EXPECT_GT(compared, 5000);
    }
}

TEST(RayCaster, FarFromTheWorldsOrigin) {
    BlockMap map{BlockMap::Config{}};
    const Eigen::Vector3d centre(400.003, -250.002, 123.001);
    const BlockCoord block{static_cast<int>(400 / .08), static_cast<int>(-250 / .08),
                           static_cast<int>(123 / .08)};
    Fill(map, Sphere(centre, .2), {block.x - 4, block.y - 4, block.z - 4},
         {block.x + 4, block.y + 4, block.z + 4});
    const Eigen::Isometry3d T = LookAt(centre + Eigen::Vector3d(0, .1, -1), centre, 0);
    const PredictedView view = Cast(map, SmallCamera(), T, .1f, 3.f);
    double cosine;
    for (int v = 50; v < 70; ++v)
        for (int u = 70; u < 90; ++u)
            ASSERT_NEAR(view.depth_m(u, v),
                        SphereDepth(SmallCamera(), T, u, v, centre, .2, &cosine), 2e-4);
}

TEST(RayCaster, ColourAndIntensityAreInterpolated) {
    const Paint paint = [](const Eigen::Vector3d& p) {
        return Eigen::Vector3d(.5 + p.x(), .4 - p.y(), .5 + .5 * p.z());
    };
    BlockMap map{BlockMap::Config{}};
    Fill(map, Sphere({0, 0, 0}, .3), {-6, -6, -6}, {5, 5, 5}, paint);
    const PinholeCamera camera = SmallCamera();
    const Eigen::Isometry3d T = LookAt({.5, .4, -.8}, {0, 0, 0});
    const PredictedView view = Cast(map, camera, T, .1f, 3.f);
    EXPECT_GT(CountHits(view), 3000);
    for (int v = 0; v < camera.height; ++v)
        for (int u = 0; u < camera.width; ++u) {
            if (view.depth_m(u, v) == 0) continue;
            const Eigen::Vector3d rgb =
                paint(T * camera.Unproject(u, v, static_cast<double>(view.depth_m(u, v))));
            ASSERT_NEAR(view.intensity(u, v), Luma(rgb), 1e-4);
            ASSERT_NEAR(view.colour(u, v).r, 255 * rgb.x(), 1.2);
            ASSERT_NEAR(view.colour(u, v).g, 255 * rgb.y(), 1.2);
            ASSERT_NEAR(view.colour(u, v).b, 255 * rgb.z(), 1.2);
        }
}

TEST(RayCaster, SurfaceWithoutColourSaysSo) {
    BlockMap map{BlockMap::Config{}};
    Fill(map, Sphere({0, 0, 0}, .3), {-6, -6, -6}, {5, 5, 5});
    const PredictedView view = Cast(map, SmallCamera(), LookAt({0, 0, -1}, {0, 0, 0}), .1f, 3.f);
    ASSERT_GT(view.depth_m(80, 60), 0);
    EXPECT_EQ(view.intensity(80, 60), -1);
    EXPECT_EQ(view.colour(80, 60), (Rgb8{128, 128, 128}));
}

TEST(RayCaster, NothingToSee) {
    BlockMap map{BlockMap::Config{}};
    RayCaster caster;
    const PinholeCamera camera = SmallCamera();
    PredictedView view = Cast(map, camera, LookAt({0, 0, -1}, {0, 0, 0}), .1f, 3.f);
    EXPECT_EQ(CountHits(view), 0);
    Fill(map, Sphere({0, 0, 0}, .3), {-6, -6, -6}, {5, 5, 5});
    caster.Predict(map, camera, LookAt({0, 0, -1}, {0, 0, 0}), .1f, 3.f, view);
    EXPECT_GT(CountHits(view), 3000);
    caster.Predict(map, camera, LookAt({0, 0, -1}, {0, 0, -2}), .1f, 3.f, view);  // looks away
    EXPECT_EQ(CountHits(view), 0);
    caster.Predict(map, camera, LookAt({0, 0, -1}, {0, 0, 0}), .1f, .6f, view);  // out of range
    EXPECT_EQ(CountHits(view), 0);
    caster.Predict(map, camera, LookAt({0, 0, 0}, {0, 0, 1}), .1f, 3.f,
                   view);  // sees the back from inside
    EXPECT_EQ(CountHits(view), 0);
    for (std::size_t i = 0; i < view.depth_m.size(); ++i) {
        ASSERT_EQ(view.normal_camera.data()[i].norm(), 0);
        ASSERT_EQ(view.intensity.data()[i], 0);
        ASSERT_EQ(view.colour.data()[i], Rgb8{});
    }
}

// Unknown voxels are no surface, even next to free space. A jump over the whole range is no surface
// either.
TEST(RayCaster, NoSurfaceAtUnknownSpaceNorAtJumps) {
    BlockMap map{BlockMap::Config{}};
    Fill(map, Plane({0, 0, -1}, 0), {-4, -4, -1}, {3, 3, 0});
    const Eigen::Isometry3d T = LookAt({.01, .01, -1}, {0, 0, 0});
    EXPECT_GT(CountHits(Cast(map, SmallCamera(), T, .1f, 3.f)), 2000);
    for (BlockId id = 1; id < map.size(); ++id)
        for (int i = 0; i < kBlockVoxels; ++i)
            if (FieldDistance(map.field(id)[i]) <= 0) map.field(id)[i] = kUnknownField;
    EXPECT_EQ(CountHits(Cast(map, SmallCamera(), T, .1f, 3.f)), 0);
    for (BlockId id = 1; id < map.size(); ++id)
        for (int i = 0; i < kBlockVoxels; ++i)
            map.field(id)[i] = PackField(HasDistance(map.field(id)[i]) ? 1 : -1);
    EXPECT_EQ(CountHits(Cast(map, SmallCamera(), T, .1f, 3.f)), 0);
}

// The nearer surface wins. Rays that pass its edge reach the wall.
TEST(RayCaster, OccluderInFrontOfAWall) {
    BlockMap map{BlockMap::Config{}};
    Fill(map, Union(Sphere({0, 0, 0}, .1), Plane({0, 0, -1}, -.5)), {-12, -12, -2}, {11, 11, 7});
    const PinholeCamera camera = SmallCamera();
    const Eigen::Isometry3d T = LookAt({0, 0, -1}, {0, 0, 1}, 0);
    const PredictedView view = Cast(map, camera, T, .1f, 3.f);
    for (int v = 0; v < camera.height; ++v)
        for (int u = 0; u < camera.width; ++u) {
            double cosine = 1;
            const double sphere = SphereDepth(camera, T, u, v, {0, 0, 0}, .1, &cosine);
            if (sphere > 0 && cosine < .3) continue;
            ASSERT_NEAR(view.depth_m(u, v), sphere > 0 ? sphere : 1.5, kTenthVoxel)
                << u << " " << v;
        }
}

TEST(RayCaster, SameBytesForAnyNumberOfThreads) {
    BlockMap map{BlockMap::Config{}};
    Fill(map, Torus({0, 0, 0}, .3, .1), {-6, -6, -6}, {5, 5, 5},
         [](const Eigen::Vector3d& p) { return Eigen::Vector3d(.5 + p.x(), .5, .5); });
    const auto with_threads = [&](std::size_t n) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, n);
        return Cast(map, SmallCamera(), LookAt({.3, .5, -.8}, {0, 0, 0}), .1f, 3.f);
    };
    const PredictedView one = with_threads(1), four = with_threads(4);
    EXPECT_TRUE(one.depth_m == four.depth_m);
    EXPECT_TRUE(one.normal_camera == four.normal_camera);
    EXPECT_TRUE(one.colour == four.colour);
    EXPECT_TRUE(one.intensity == four.intensity);
}

}  // namespace
}  // namespace tessera
