#include "mapping/integrator.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/cpu.h"
#include "mapping/integrator_fixture.h"
#include "support/box_room.h"

namespace tessera {
namespace {

using testing_support::BoxRoom;
using testing_support::SmallCamera;
using testing_support::SmoothPath;

TEST(Integrator, PlaneGivesItsExactDistance) {
    const PinholeCamera camera = SmallCamera();
    BlockMap map(MapConfig());
    Integrator integrator({}, camera);
    for (int i = 0; i < 3; ++i)
        integrator.Integrate(Prepare(UniformFrame(camera, 1.0f, {90, 120, 30})), {}, map);
    int voxels = 0;
    ForKnownVoxels(map, [&](const Eigen::Vector3d& p, FieldWord field, std::uint16_t, ColourWord) {
        const double exact = std::clamp(1.0 - p.z(), -0.08, 0.08);
        ASSERT_NEAR(FieldDistance(field) * 0.08, exact, 1e-5) << p.transpose();
        ++voxels;
    });
    EXPECT_GT(voxels, 20000);
}

// Depths that scatter by 6 cm around 4 m, and none around 1 m. With a band of 8 cm the far surface
// moves backwards; a band that grows to four standard deviations leaves it where it is.
TEST(Integrator, ABandThatGrowsKeepsANoisySurfaceInItsPlace) {
    const PinholeCamera camera = SmallCamera();
    for (const double band_per_m : {0.0, 0.015}) {
        BlockMap::Config config = MapConfig();
        config.band_per_m = band_per_m;
        BlockMap map(config);
        Integrator::Config equal;
        equal.distance_weight = DistanceWeight::kConstant;
        Integrator integrator(equal, camera);
        for (const double x :
             {1.5, -0.2, 0.6, -1.1, 0.0, 1.1, -0.6, 0.2, -1.5, 0.4, -0.4, 2.0, -2.0})
            integrator.Integrate(
                Prepare(UniformFrame(camera, static_cast<float>(4 + 0.06 * x), {90, 120, 30})), {},
                map);
        integrator.Integrate(Prepare(UniformFrame(camera, 1.0f, {90, 120, 30})), {}, map);
        double off_m = 0, widest_near_m = 0;
        int count = 0;
        ForKnownVoxels(map,
                       [&](const Eigen::Vector3d& p, FieldWord field, std::uint16_t, ColourWord) {
                           const double distance_m = FieldDistance(field) * config.range_m();
                           if (p.z() < 2)
                               widest_near_m = std::max(widest_near_m, std::abs(distance_m));
                           if (std::abs(p.z() - 4) > 0.011 || p.head<2>().norm() > 0.5) return;
                           off_m += distance_m - (4 - p.z());
                           ++count;
                       });
        ASSERT_GT(count, 100);
        EXPECT_LT(widest_near_m, 0.0801);
        if (band_per_m > 0)
            EXPECT_NEAR(off_m / count, 0, 1e-3);
        else
            EXPECT_GT(off_m / count, 0.01);
    }
}

TEST(Integrator, WeightIsTheNumberOfFramesOverDepthSquared) {
    const PinholeCamera camera = SmallCamera();
    BlockMap map(MapConfig());
    Integrator integrator({}, camera);
    for (int i = 0; i < 5; ++i)
        integrator.Integrate(Prepare(UniformFrame(camera, 2.0f, {9, 9, 9})), {}, map);
    ForKnownVoxels(map, [&](const Eigen::Vector3d& p, FieldWord, std::uint16_t weight, ColourWord) {
        if (std::abs(p.x()) > 0.5 || std::abs(p.y()) > 0.5) return;
        ASSERT_EQ(weight, static_cast<int>(5 * kWeightSteps / 4)) << p.transpose();
    });
}

TEST(Integrator, RoomMatchesTheExactFieldNearTheSurface) {
    // The measured distance runs along the optical axis ([B14] eq. 12). At an angle it exceeds the
    // exact distance by a factor of at most 1 / cosine, so both have the same zero and the same
    // sign.
    const PinholeCamera camera = SmallCamera();
    BoxRoom room;
    BlockMap map(MapConfig(0.02, 0.08));
    Integrator integrator({}, camera);
    for (int i = 0; i < 20; ++i)
        integrator.Integrate(Prepare(room.Render(camera, SmoothPath(4 * i))), At(SmoothPath(4 * i)),
                             map);
    int voxels = 0, off = 0;
    ForKnownVoxels(map, [&](const Eigen::Vector3d& p, FieldWord field, std::uint16_t, ColourWord) {
        const double exact = room.SignedDistance(p);
        if (std::abs(p.z() - room.high.z()) > 0.06) return;  // only the wall that the camera faces
        if (std::abs(p.x()) > 0.8 || std::abs(p.y()) > 0.6) return;
        ++voxels;
        off += std::abs(FieldDistance(field) * 0.08 - exact) > 0.004;
    });
    EXPECT_GT(voxels, 2000);
    EXPECT_LT(off, voxels / 100);
}

TEST(Integrator, ColourComesBack) {
    const PinholeCamera camera = SmallCamera();
    BlockMap map(MapConfig());
    Integrator integrator({}, camera);
    const Rgb8 colour{200, 90, 40};
    for (int i = 0; i < 8; ++i)
        integrator.Integrate(Prepare(UniformFrame(camera, 1.0f, colour)), {}, map);
    int coloured = 0;
    ForKnownVoxels(map,
                   [&](const Eigen::Vector3d& p, FieldWord field, std::uint16_t, ColourWord word) {
                       if (!HasIntensity(field)) return;
                       const LinearRgb rgb = ColourFromWords(field, word);
                       ASSERT_NEAR(rgb.r * 255, colour.r, 1.6) << p.transpose();
                       ASSERT_NEAR(rgb.g * 255, colour.g, 1.6);
                       ASSERT_NEAR(rgb.b * 255, colour.b, 1.6);
                       ++coloured;
                   });
    EXPECT_GT(coloured, 5000);
}

TEST(Integrator, BrightnessIsTakenBackToTheMaps) {
    const PinholeCamera camera = SmallCamera();
    BlockMap map(MapConfig());
    Integrator integrator({}, camera);
    Integrator::View view;
    view.gain = 1.5f;
    view.offset = 0.05f;
    integrator.Integrate(Prepare(UniformFrame(camera, 1.0f, {100, 100, 100})), view, map);
    ForKnownVoxels(map, [&](const Eigen::Vector3d&, FieldWord field, std::uint16_t, ColourWord) {
        if (!HasIntensity(field)) return;
        ASSERT_NEAR(FieldIntensity(field), 1.5 * 100 / 255.0 + 0.05, 1e-4);
    });
}

// 8-bit averages, and 16-bit averages rounded to nearest, stop moving once the weight is large.
TEST(Integrator, TenThousandFramesConverge) {
    const PinholeCamera camera{24, 18, 100, 100, 11.5, 8.5};
    BlockMap map(MapConfig(0.02, 0.04));
    Integrator integrator({}, camera);
    const PreparedFrame wrong = Prepare(UniformFrame(camera, 1.010f, {255, 120, 120}));
    const PreparedFrame right = Prepare(UniformFrame(camera, 1.000f, {100, 128, 140}));
    for (int i = 0; i < 500; ++i) integrator.Integrate(wrong, {}, map);
    for (int i = 0; i < 9500; ++i) integrator.Integrate(right, {}, map);
    double worst_distance = 0, worst_colour = 0;
    int voxels = 0;
    ForKnownVoxels(
        map, [&](const Eigen::Vector3d& p, FieldWord field, std::uint16_t, ColourWord word) {
            if (std::abs(p.z() - 1.0) > 0.025 || !HasIntensity(field)) return;
            const LinearRgb rgb = ColourFromWords(field, word);
            worst_distance =
                std::max(worst_distance, std::abs(FieldDistance(field) * 0.04 - (1.0 - p.z())));
            worst_colour = std::max({worst_colour, std::abs(rgb.r * 255.0 - 100),
                                     std::abs(rgb.g * 255.0 - 128), std::abs(rgb.b * 255.0 - 140)});
            ++voxels;
        });
    EXPECT_GT(voxels, 100);
    EXPECT_LT(worst_distance, 2e-4);
    EXPECT_LT(worst_colour, 4.0);  // 8-bit chroma of one frame, plus the spread of the dither
}

TEST(Integrator, PortableAndAvx2Agree) {
    if (!CpuHasAvx2()) GTEST_SKIP() << "this machine has no AVX2";
    const PinholeCamera camera = SmallCamera();
    BoxRoom room;
    room.has_ball = true;
    BlockMap maps[2] = {BlockMap(MapConfig()), BlockMap(MapConfig())};
    Integrator integrators[2] = {Integrator({}, camera, VectorPath::kBaseline),
                                 Integrator({}, camera, VectorPath::kAvx2)};
    for (int i = 0; i < 5; ++i)
        for (int k = 0; k < 2; ++k)
            integrators[k].Integrate(Prepare(room.Render(camera, SmoothPath(10 * i))),
                                     At(SmoothPath(10 * i)), maps[k]);
    ASSERT_EQ(maps[0].size(), maps[1].size());
    std::int64_t voxels = 0, differ = 0;
    for (BlockId id = 1; id < maps[0].size(); ++id)
        for (int i = 0; i < kBlockVoxels; ++i) {
            const FieldWord a = maps[0].field(id)[i], b = maps[1].field(id)[i];
            ++voxels;
            differ += HasDistance(a) != HasDistance(b) ||
                      std::abs(FieldDistance(a) - FieldDistance(b)) > 1e-3f;
        }
    // Fused multiply-adds occasionally move a projection across a pixel border, and the
    // neighbouring pixel has a different depth.
    EXPECT_LT(differ, voxels / 1000);
}

TEST(Integrator, ThreadsDoNotChangeAByte) {
    const PinholeCamera camera = SmallCamera();
    BoxRoom room;
    room.has_ball = true;
    BlockMap maps[2] = {BlockMap(MapConfig()), BlockMap(MapConfig())};
    for (int k = 0; k < 2; ++k) {
        tbb::global_control threads(tbb::global_control::max_allowed_parallelism, k == 0 ? 1 : 4);
        Integrator integrator({}, camera);
        for (int i = 0; i < 5; ++i)
            integrator.Integrate(Prepare(room.Render(camera, SmoothPath(10 * i))),
                                 At(SmoothPath(10 * i)), maps[k]);
    }
    ASSERT_EQ(maps[0].size(), maps[1].size());
    const auto bytes = static_cast<std::size_t>(maps[0].size()) * kBlockVoxels;
    EXPECT_EQ(std::memcmp(maps[0].field(0), maps[1].field(0), bytes * sizeof(FieldWord)), 0);
    EXPECT_EQ(std::memcmp(maps[0].colour(0), maps[1].colour(0), bytes * sizeof(ColourWord)), 0);
    EXPECT_EQ(std::memcmp(maps[0].weight(0), maps[1].weight(0), bytes * sizeof(std::uint16_t)), 0);
}

TEST(Integrator, FarFromTheOriginIsAsFine) {
    const PinholeCamera camera = SmallCamera();
    BlockMap map(MapConfig(0.02, 0.08));
    Integrator integrator({}, camera);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() << 409.6, -204.8, 1024.0;  // a whole number of blocks
    integrator.Integrate(Prepare(UniformFrame(camera, 1.0f, {90, 90, 90})), At(T), map);
    ForKnownVoxels(map, [&](const Eigen::Vector3d& p, FieldWord field, std::uint16_t, ColourWord) {
        ASSERT_NEAR(FieldDistance(field) * 0.08, std::clamp(1025.0 - p.z(), -0.08, 0.08), 1e-4);
    });
}

}  // namespace
}  // namespace tessera
