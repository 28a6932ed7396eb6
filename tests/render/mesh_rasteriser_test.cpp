#include "render/mesh_rasteriser.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <thread>

#include "mapping/analytic_fields.h"
#include "mapping/ray_caster.h"

namespace tessera {
namespace {

using namespace testing;

constexpr double kVoxel_m = .01;

PinholeCamera SmallCamera() {
    return {160, 120, 140, 145, 79.5, 60.5};
}

Eigen::Isometry3d LookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, double roll_rad = .3) {
    Eigen::Matrix3d R;
    R.col(2) = (target - eye).normalized();
    R.col(0) = Eigen::Vector3d(.1, 1, .2).cross(R.col(2)).normalized();
    R.col(1) = R.col(2).cross(R.col(0));
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = R * Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    T.translation() = eye;
    return T;
}

int CountHits(const PredictedView& view) {
    return static_cast<int>(std::count_if(view.depth_m.data(), view.depth_m.data() + view.depth_m.size(),
                                          [](float z) { return z > 0; }));
}

bool SameBytes(const PredictedView& a, const PredictedView& b) {
    return a.depth_m == b.depth_m && a.normal_camera == b.normal_camera && a.colour == b.colour &&
           a.intensity == b.intensity;
}

double Median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values.at(values.size() / 2);
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

PredictedView Cast(const BlockMap& map, const PinholeCamera& camera, const Eigen::Isometry3d& T,
                   float min_depth_m = .1f, float max_depth_m = 5.f) {
    PredictedView view;
    RayCaster().Predict(map, camera, T, min_depth_m, max_depth_m, view);
    return view;
}

// Marching cubes meets a plane exactly: so must every pixel, with any intrinsics.
TEST_F(MeshRasteriserTest, ObliquePlaneIsExact) {
    const Eigen::Vector3d normal = Eigen::Vector3d(.3, -.2, -1).normalized();
    BlockMap map{BlockMap::Config{}};
    Fill(map, Plane(normal, .013), {-14, -14, -8}, {13, 13, 7});
    const Eigen::Isometry3d T = LookAt({.2, .1, -.9}, {-.1, .05, 0});
    for (const PinholeCamera& camera :
         {SmallCamera(), PinholeCamera{160, 120, 170, 110, 31.25, 98.75}, PinholeCamera{33, 57, 40, 40, 16, 28}}) {
        const PredictedView view = Draw(map, camera, T, .1f, 3.f);
        EXPECT_EQ(view.camera, camera);
        int compared = 0;
        for (int v = 0; v < camera.height; ++v)
            for (int u = 0; u < camera.width; ++u) {
                const Eigen::Vector3d ray = T.linear() * camera.Unproject(u, v, 1);
                const double z = (.013 - normal.dot(T.translation())) / normal.dot(ray);
                if (z < .1 || z > 3 || (T.translation() + z * ray).cwiseAbs().maxCoeff() > .9) continue;
                ++compared;
                ASSERT_NEAR(view.depth_m(u, v), z, 5e-5 / std::abs(normal.dot(ray.normalized()))) << u << " " << v;
                ASSERT_LT((T.linear() * view.normal_camera(u, v).cast<double>() - normal).norm(), 2e-3);
                ASSERT_NEAR(view.normal_camera(u, v).norm(), 1, 1e-5);
            }
        EXPECT_GT(compared, camera.width * camera.height / 2);
    }
}

double SceneDistance(const Eigen::Vector3d& p) {
    static const Sdf kTorus = Torus({.3, -.1, 0}, .2, .07), kBall = Sphere({-.25, .2, .1}, .2);
    return std::min({kTorus(p), kBall(p), .35 + .02 * std::sin(8 * p.x()) - p.z()});
}

// A scene without any symmetry, painted.
void FillScene(BlockMap& map, std::uint32_t revision = 1) {
    Fill(map, SceneDistance, {-9, -9, -4}, {8, 8, 5},
         [](const Eigen::Vector3d& p) {
             return Eigen::Vector3d(.5 + .4 * p.x(), .5 - .4 * p.y(), .5 + .3 * std::sin(20 * p.x() + 9 * p.y()));
         },
         revision);
}

// Whether the depth runs on smoothly around the pixel, by the ray cast view.
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
    for (const Eigen::Vector3d& eye : {Eigen::Vector3d(.1, .2, -1), Eigen::Vector3d(.7, -.6, -.5)}) {
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
    EXPECT_NEAR(u_sum / hits, 79.5 + .3 * 140, .8);  // right of the middle
    EXPECT_NEAR(v_sum / hits, 60.5 - .2 * 145, .8);  // above it
    // The sphere's left side faces left, its top upwards.
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
    for (const PredictedView& view : {Draw(map, camera, LookAt({0, 0, -1}, {0, 0, -2})),              // away from it
                                      Draw(map, camera, LookAt({0, 0, -1}, {0, 0, 0}), .1f, .6f),     // too far
                                      Draw(map, camera, LookAt({0, 0, 0}, {0, 0, 1}))}) {             // its back
        EXPECT_EQ(CountHits(view), 0);
        for (std::size_t i = 0; i < view.depth_m.size(); ++i) {
            ASSERT_EQ(view.normal_camera.data()[i].norm(), 0);
            ASSERT_EQ(view.intensity.data()[i], 0);
            ASSERT_EQ(view.colour.data()[i], Rgb8{});
        }
    }
}

TEST_F(MeshRasteriserTest, FarFromTheWorldsOrigin) {
    const Eigen::Vector3d normal = Eigen::Vector3d(.1, -.2, -1).normalized(), middle(400.003, -250.002, 123.001);
    BlockMap map{BlockMap::Config{}};
    const Eigen::Vector3i block = (middle / .08).array().floor().cast<int>();
    Fill(map, Plane(normal, normal.dot(middle)), {block.x() - 6, block.y() - 6, block.z() - 4},
         {block.x() + 6, block.y() + 6, block.z() + 4});
    const Eigen::Isometry3d T = LookAt(middle + Eigen::Vector3d(0, .1, -.8), middle, 0);
    const PredictedView view = Draw(map, SmallCamera(), T, .1f, 3.f);
    for (int v = 40; v < 80; ++v)
        for (int u = 60; u < 100; ++u) {
            const Eigen::Vector3d ray = T.linear() * SmallCamera().Unproject(u, v, 1);
            ASSERT_NEAR(view.depth_m(u, v), normal.dot(middle - T.translation()) / normal.dot(ray), 4e-5);
        }
}

// What changed is drawn as if everything were new, through the lower neighbours' copies of vertices too; and blocks
// that are meshed over and over use the same memory.
TEST_F(MeshRasteriserTest, AfterChangesTheSameAsAFreshOne) {
    BlockMap map{BlockMap::Config{}};
    FillScene(map);
    const Eigen::Isometry3d T = LookAt({.1, .2, -1}, {0, 0, .2});
    const PredictedView before = Draw(map, SmallCamera(), T);
    std::size_t bytes = 0;
    for (std::uint32_t revision = 2; revision < 40; ++revision) {
        const Sdf ball = Sphere({.2 * std::sin(revision), .2 * std::cos(revision), 0}, .15);
        for (BlockId id = 1; id < map.size(); ++id)
            if (Uniform(static_cast<std::uint32_t>(id) * 64 + revision) < .3)
                FillBlock(map, id, Union(SceneDistance, ball), nullptr, revision);
        if (revision == 20) map.MarkChanged(map.Allocate({3, 3, -5}), revision);
        const PredictedView changed = Draw(map, SmallCamera(), T);
        EXPECT_FALSE(SameBytes(before, changed));
        if (revision == 10) bytes = rasteriser_->bytes();
        if (revision % 13 != 0) continue;
        const auto fresh = Make();
        PredictedView expected;
        fresh->Predict(map, SmallCamera(), T, .1f, 5.f, expected);
        EXPECT_TRUE(SameBytes(changed, expected)) << revision;
    }
    EXPECT_LT(rasteriser_->bytes(), bytes + bytes / 3);
}

// What was uploaded before the buffers had to grow is still there.
TEST_F(MeshRasteriserTest, TheMapGrows) {
    BlockMap map{BlockMap::Config{}};
    FillScene(map);
    const Eigen::Isometry3d T = LookAt({.1, .2, -1}, {0, 0, .2});
    const PredictedView before = Draw(map, SmallCamera(), T);
    const std::size_t bytes = rasteriser_->bytes();
    Fill(map, Plane({0, 0, -1}, -6), {-20, -20, 73}, {19, 19, 76}, nullptr, 2);
    EXPECT_TRUE(SameBytes(Draw(map, SmallCamera(), T), before));
    EXPECT_GT(rasteriser_->bytes(), 2 * bytes);
    EXPECT_GT(CountHits(Draw(map, SmallCamera(), LookAt({0, 0, 5}, {0, 0, 6}))), 15000);
}

TEST_F(MeshRasteriserTest, AnotherOrClearedMapIsTakenUpFromScratch) {
    BlockMap first{BlockMap::Config{}};
    FillScene(first);
    const Eigen::Isometry3d T = LookAt({.1, .2, -1}, {0, 0, .2});
    const PredictedView before = Draw(first, SmallCamera(), T);
    BlockMap::Config coarse;
    coarse.voxel_size_m = .02;
    coarse.truncation_m = .08;
    BlockMap second{coarse};
    Fill(second, Sphere({0, 0, 0}, .3), {-3, -3, -3}, {2, 2, 2});
    const PredictedView ball = Draw(second, SmallCamera(), T);
    EXPECT_NEAR(CountHits(ball), CountHits(Cast(second, SmallCamera(), T)), 100);
    EXPECT_TRUE(SameBytes(Draw(first, SmallCamera(), T), before));
    first.Clear();
    EXPECT_EQ(CountHits(Draw(first, SmallCamera(), T)), 0);
    FillScene(first);  // the same blocks with the same revisions
    EXPECT_TRUE(SameBytes(Draw(first, SmallCamera(), T), before));
}

TEST_F(MeshRasteriserTest, CamerasMayChangeTheirSizeOrBeTooLarge) {
    BlockMap map{BlockMap::Config{}};
    FillScene(map);
    const Eigen::Isometry3d T = LookAt({.1, .2, -1}, {0, 0, .2});
    const PredictedView small = Draw(map, SmallCamera(), T);
    const PredictedView large = Draw(map, {321, 241, 280, 290, 159.5, 121.5}, T);
    EXPECT_EQ(large.depth_m.width(), 321);
    EXPECT_GT(CountHits(large), 3 * CountHits(small));
    EXPECT_TRUE(SameBytes(Draw(map, SmallCamera(), T), small));
    PredictedView nothing;
    rasteriser_->Predict(map, {1 << 20, 1, 280, 290, 0, 0}, T, .1f, 5.f, nothing);
    EXPECT_FALSE(rasteriser_->status().ok());
    EXPECT_EQ(CountHits(nothing), 0);
    EXPECT_TRUE(SameBytes(Draw(map, SmallCamera(), T), small));
}

TEST_F(MeshRasteriserTest, SameBytesForAnyNumberOfThreads) {
    BlockMap map{BlockMap::Config{}};
    FillScene(map);
    const auto with_threads = [&](std::size_t n) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, n);
        PredictedView view;
        Make()->Predict(map, SmallCamera(), LookAt({.1, .2, -1}, {0, 0, .2}), .1f, 5.f, view);
        return view;
    };
    EXPECT_TRUE(SameBytes(with_threads(1), with_threads(4)));
}

// The last one given back, two at a time, and used on another thread than it was made on.
TEST_F(MeshRasteriserTest, ContextsComeAndGo) {
    BlockMap map{BlockMap::Config{}};
    FillScene(map);
    const Eigen::Isometry3d T = LookAt({.1, .2, -1}, {0, 0, .2});
    const PredictedView expected = Draw(map, SmallCamera(), T);
    EXPECT_NE(rasteriser_->renderer().find("OpenGL"), std::string::npos);
    for (int i = 0; i < 3; ++i) {
        rasteriser_.reset();
        rasteriser_ = Make();
        ASSERT_TRUE(rasteriser_);
        const auto other = Make();
        PredictedView view;
        std::thread([&] { other->Predict(map, SmallCamera(), T, .1f, 5.f, view); }).join();
        EXPECT_TRUE(SameBytes(view, expected));
        EXPECT_TRUE(SameBytes(Draw(map, SmallCamera(), T), expected));
    }
}

}  // namespace
}  // namespace tessera
