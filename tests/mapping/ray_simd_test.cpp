// Checks the SIMD ray caster against a scalar reference and against itself. The map has holes,
// missing blocks, noise, and surfaces with and without colour.
#include "mapping/ray_simd.h"

#include <gtest/gtest.h>

#include <cstring>

#include "core/scalar_lanes.h"
#include "mapping/analytic_fields.h"
#include "mapping/ray_caster.h"
#include "mapping/ray_kernels.h"
#include "mapping/scalar_ray_walker.h"

namespace tessera {
namespace {

using namespace testing_support;

constexpr float kNear_m = 0.1f, kFar_m = 4.f;
constexpr float kTenthVoxel_m = 1e-3f;

// The width is not a multiple of the tile size or the SIMD width.
PinholeCamera OddCamera() { return {205, 149, 190, 195, 101.5, 73.5}; }

// Noise of a quarter voxel. One voxel in 50 is unknown, one block in 20 is missing, and half of the
// others have no colour.
BlockMap& RoughMap() {
    static BlockMap map{BlockMap::Config{}};
    if (map.size() > 1) return map;
    const Sdf room = Union(Union(Sphere({-.2, .1, .1}, .3), Box({.4, -.1, .2}, {.15, .3, .2})),
                           Plane({0, 0, -1}, -.6));
    const Paint paint = [](const Eigen::Vector3d& p) {
        return Eigen::Vector3d(.5 + .3 * p.x(), .5 - .3 * p.y(), .4);
    };
    Fill(map, room, {-14, -14, -6}, {13, 13, 9}, paint);
    std::uint32_t counter = 0;
    for (BlockId id = 1; id < map.size(); ++id) {
        const bool missing = Uniform(++counter) < .05, grey = Uniform(++counter) < .5;
        for (int i = 0; i < kBlockVoxels; ++i) {
            FieldWord& word = map.field(id)[i];
            const double noise = .0025 / map.config().truncation_m * (2 * Uniform(++counter) - 1);
            word = PackField(static_cast<double>(FieldDistance(word)) + noise,
                             grey ? -1 : static_cast<double>(FieldIntensity(word)));
            if (missing || Uniform(++counter) < .02) word = kUnknownField;
        }
    }
    return map;
}

std::vector<Eigen::Isometry3d> Views() {
    std::vector<Eigen::Isometry3d> views(4, Eigen::Isometry3d::Identity());
    views[0].translation() = Eigen::Vector3d(.013, .027, -.9);
    views[1].linear() =
        Eigen::AngleAxisd(.7, Eigen::Vector3d(.2, 1, .1).normalized()).toRotationMatrix();
    views[1].translation() = Eigen::Vector3d(-.8, .1, -.5);
    views[2].linear() =
        Eigen::AngleAxisd(-1.2, Eigen::Vector3d(1, .1, .2).normalized()).toRotationMatrix();
    views[2].translation() = Eigen::Vector3d(.1, -1.1, .3);
    // Rays parallel to the axes, and objects close to the camera.
    views[3].translation() = Eigen::Vector3d(.1, -.2, -.35);
    return views;
}

PredictedView CastOnPath(const Eigen::Isometry3d& T_world_camera, VectorPath path) {
    PredictedView view;
    RayCaster(path).Predict(RoughMap(), OddCamera(), T_world_camera, kNear_m, kFar_m, view);
    return view;
}

// If the end of a bracket falls within rounding error of a voxel border or of a step end, the two
// walks may diverge. This fraction of the pixels may differ by any amount.
constexpr double kMayDiffer = 1e-4;

class RayRows : public ::testing::TestWithParam<VectorPath> {};

TEST_P(RayRows, AgreesWithTheScalarWalk) {
    if (GetParam() == VectorPath::kAvx2 && !CpuHasAvx2())
        GTEST_SKIP() << "this machine has no AVX2";
    const PinholeCamera camera = OddCamera();
    int hits = 0, pixels = 0, differ = 0, coloured = 0;
    for (const Eigen::Isometry3d& T : Views()) {
        const PredictedView view = CastOnPath(T, GetParam());
        ScalarRayWalker oracle(RoughMap(), camera, T, kNear_m, kFar_m);
        for (int v = 0; v < camera.height; ++v)
            for (int u = 0; u < camera.width; ++u, ++pixels) {
                const auto expected = oracle.Cast(u, v);
                hits += expected.depth_m > 0;
                if (!(std::abs(view.depth_m(u, v) - expected.depth_m) < 0.05f * kTenthVoxel_m) ||
                    !((view.normal_camera(u, v) - expected.normal_camera).norm() < 1e-2f)) {
                    ++differ;
                    continue;
                }
                if (!expected.has_intensity) continue;
                ++coloured;
                ASSERT_NEAR(view.intensity(u, v), expected.intensity, 1e-4) << u << " " << v;
            }
    }
    EXPECT_GT(hits, pixels / 3);
    EXPECT_GT(coloured, hits / 10);
    EXPECT_LT(differ, kMayDiffer * pixels) << "of " << pixels << ", " << hits << " hits";
    RecordProperty("differ", differ);
}

INSTANTIATE_TEST_SUITE_P(Paths, RayRows,
                         ::testing::Values(VectorPath::kBaseline, VectorPath::kAvx2),
                         [](const auto& test) {
                             return test.param == VectorPath::kAvx2 ? "Avx2" : "Baseline";
                         });

template <class T>
bool SameBytes(const Image<T>& a, const Image<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

// The result has the same bytes as the kernels applied one pixel at a time without the SIMD block
// cache.
TEST_P(RayRows, AreTheKernelsOneByOne) {
    if (GetParam() == VectorPath::kAvx2 && !CpuHasAvx2())
        GTEST_SKIP() << "this machine has no AVX2";
    using Kernels = RayKernels<ScalarLanes, HashedBlocks<ScalarLanes>>;
    const PinholeCamera camera = OddCamera();
    const RayTile tile{0, camera.width, 0, camera.height, kNear_m, kFar_m};
    const auto cast = GetParam() == VectorPath::kAvx2 ? avx2::CastTiles : baseline::CastTiles;
    for (const Eigen::Isometry3d& T : Views()) {
        PredictedView a, b;
        a.Resize(camera, T);
        b.Resize(camera, T);
        cast(RayArgumentsFor(RoughMap(), a), &tile, 1);
        const RayArguments arguments = RayArgumentsFor(RoughMap(), b);
        Kernels::Walker walker(arguments);
        for (int v = 0; v < camera.height; ++v)
            for (int u = 0; u < camera.width; ++u)
                Kernels::CastPixels(arguments, walker, tile, u, v);
        EXPECT_TRUE(SameBytes(a.depth_m, b.depth_m));
        EXPECT_TRUE(SameBytes(a.normal_camera, b.normal_camera));
        EXPECT_TRUE(SameBytes(a.colour, b.colour));
        EXPECT_TRUE(SameBytes(a.intensity, b.intensity));
    }
}

// The camera axes are parallel to the world axes, so components of the ray steps are exactly zero.
TEST(RayRowsPaths, RaysParallelToAxes) {
    BlockMap map{BlockMap::Config{}};
    Fill(map, Plane({0, 0, -1}, -.53), {-6, -6, 2}, {5, 5, 9});
    PinholeCamera camera{33, 17, 100, 100, 16, 8};
    PredictedView view;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = Eigen::Vector3d(0, 0, -.56);  // on a block corner
    for (const VectorPath path : {VectorPath::kBaseline, VectorPath::kAuto}) {
        RayCaster(path).Predict(map, camera, T, kNear_m, kFar_m, view);
        for (int v = 0; v < camera.height; ++v)
            for (int u = 0; u < camera.width; ++u)
                ASSERT_NEAR(view.depth_m(u, v), 1.09, 1e-4) << u << " " << v;
    }
}

}  // namespace
}  // namespace tessera
