#include "mapping/field_sampler.h"

#include <gtest/gtest.h>

#include "mapping/analytic_fields.h"

namespace tessera {
namespace {

using namespace testing_support;
using Sampler = FieldSampler<BlockMapView>;

// Blocks of random distances and intensities on both sides of zero. One block is missing.
class FieldSamplerTest : public ::testing::Test {
  protected:
    FieldSamplerTest() {
        for (int z = -2; z <= 1; ++z)
            for (int y = -2; y <= 1; ++y)
                for (int x = -2; x <= 1; ++x) {
                    if (x == 1 && y == 1 && z == 1) continue;
                    const BlockId id = map_.Allocate({x, y, z});
                    for (int i = 0; i < kBlockVoxels; ++i)
                        map_.field(id)[i] = PackField(2 * Random() - 1, Random());
                }
    }
    double Random() { return Uniform(++counter_); }
    // In [-16, 15) voxels. All of it is known except the missing block.
    Eigen::Vector3d RandomPoint() {
        return Eigen::Vector3d(Random(), Random(), Random()) * 31 - Eigen::Vector3d::Constant(16);
    }

    FieldWord WordAt(const Eigen::Vector3i& v) const {
        const auto block = [](int i) { return static_cast<int>(std::floor(i / 8.0)); };
        const BlockCoord b{block(v.x()), block(v.y()), block(v.z())};
        return map_.field(
            map_.Find(b))[v.x() - 8 * b.x + 8 * (v.y() - 8 * b.y) + 64 * (v.z() - 8 * b.z)];
    }
    // A slow, straightforward reference. NaN where a corner is unknown.
    template <class Decode>
    double Trilinear(const Eigen::Vector3d& p, const Decode& decode) const {
        const Eigen::Vector3d low = p.array().floor();
        double sum = 0;
        for (int c = 0; c < 8; ++c) {
            const Eigen::Vector3d corner = low + Eigen::Vector3d(c & 1, c >> 1 & 1, c >> 2);
            const double w = (1 - (p - corner).array().abs()).prod();
            const FieldWord word = WordAt(corner.cast<int>());
            if (!HasDistance(word)) return NAN;
            sum += w * static_cast<double>(decode(word));
        }
        return sum;
    }

    BlockMap map_{BlockMap::Config{}};
    std::uint32_t counter_ = 77;
};

TEST_F(FieldSamplerTest, AgreesWithTheObviousWayEverywhere) {
    Sampler sampler(map_.view(), {0, 0, 0});
    int known = 0;
    for (int i = 0; i < 20000; ++i) {
        const Eigen::Vector3f p = RandomPoint().cast<float>();
        const FieldSample sample = sampler.Sample<true>(sampler.Locate(p.x(), p.y(), p.z()));
        const double distance =
            .04 * Trilinear(p.cast<double>(), [](FieldWord w) { return FieldDistance(w); });
        ASSERT_EQ(sample.has_distance, !std::isnan(distance)) << p.transpose();
        ASSERT_EQ(sample.has_intensity, sample.has_distance);
        if (!sample.has_distance) continue;
        ++known;
        ASSERT_NEAR(sample.distance.value, distance, 1e-7) << p.transpose();
        ASSERT_NEAR(sample.intensity.value,
                    Trilinear(p.cast<double>(), [](FieldWord w) { return FieldIntensity(w); }),
                    1e-5);
    }
    EXPECT_GT(known, 15000);
    EXPECT_LT(known, 20000);
}

TEST_F(FieldSamplerTest, GradientAgreesWithCentralDifferences) {
    Sampler sampler(map_.view(), {0, 0, 0});
    const double h = 0.01, voxel = .01;  // voxels, metres
    for (int i = 0; i < 5000; ++i) {
        Eigen::Vector3d p = RandomPoint();
        // Keep inside a cell, away from its faces, where the gradient jumps.
        p = p.array().floor() + .05 + .9 * (p.array() - p.array().floor());
        const Eigen::Vector3f q = p.cast<float>();
        const FieldSample sample = sampler.Sample<true>(sampler.Locate(q.x(), q.y(), q.z()));
        if (!sample.has_distance) continue;
        const Eigen::Vector3d distance(sample.distance.gx, sample.distance.gy, sample.distance.gz);
        const Eigen::Vector3d intensity(sample.intensity.gx, sample.intensity.gy,
                                        sample.intensity.gz);
        for (int axis = 0; axis < 3; ++axis) {
            const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(axis), r = q.cast<double>();
            const auto slope = [&](const auto& decode) {
                return (Trilinear(r + step, decode) - Trilinear(r - step, decode)) /
                       (2 * h * voxel);
            };
            ASSERT_NEAR(distance[axis], .04 * slope([](FieldWord w) { return FieldDistance(w); }),
                        2e-4);
            ASSERT_NEAR(intensity[axis], slope([](FieldWord w) { return FieldIntensity(w); }),
                        5e-3);
        }
    }
}

TEST_F(FieldSamplerTest, OriginMovesTheCoordinatesOnly) {
    Sampler world(map_.view(), {0, 0, 0}), local(map_.view(), {-2, 1, -1});
    for (int i = 0; i < 1000; ++i) {
        const Eigen::Vector3f p =
            (RandomPoint() * 4).array().round().cast<float>() / 4;  // exact in float
        const FieldSample a = world.Sample<true>(world.Locate(p.x(), p.y(), p.z()));
        const FieldSample b = local.Sample<true>(local.Locate(p.x() + 16, p.y() - 8, p.z() + 8));
        ASSERT_EQ(a.has_distance, b.has_distance);
        if (a.has_distance) {
            ASSERT_EQ(a.distance.value, b.distance.value);
        }
    }
}

TEST_F(FieldSamplerTest, NegativeCoordinatesUseFloor) {
    Sampler sampler(map_.view(), {0, 0, 0});
    const FieldCell cell = sampler.Locate(-0.25f, -8.0f, -8.5f);
    EXPECT_EQ(cell.block, map_.Find({-1, -1, -2}));
    EXPECT_EQ(cell.x, 7);
    EXPECT_EQ(cell.y, 0);
    EXPECT_EQ(cell.z, 7);
    EXPECT_EQ(cell.fx, .75f);
    EXPECT_EQ(cell.fy, 0.f);
    EXPECT_EQ(cell.fz, .5f);
}

TEST_F(FieldSamplerTest, NearestVoxelAcrossBorders) {
    Sampler sampler(map_.view(), {0, 0, 0});
    for (int i = 0; i < 5000; ++i) {
        const Eigen::Vector3f p = RandomPoint().cast<float>();
        const FieldCell cell = sampler.Locate(p.x(), p.y(), p.z());
        if (cell.block == kUnknownBlock) continue;
        ASSERT_EQ(sampler.Nearest(cell), WordAt((p.array() + .5f).floor().cast<int>()))
            << p.transpose();
    }
}

TEST_F(FieldSamplerTest, UnknownIsInvalid) {
    Sampler sampler(map_.view(), {0, 0, 0});
    EXPECT_FALSE(sampler.Sample<true>(sampler.Locate(100, 0, 0)).has_distance);  // no block
    EXPECT_FALSE(sampler.Sample<true>(sampler.Locate(8, 8, 8)).has_distance);  // the missing block
    EXPECT_FALSE(
        sampler.Sample<true>(sampler.Locate(7.5f, 7.5f, 7.5f)).has_distance);  // missing neighbour
    EXPECT_TRUE(sampler.Sample<true>(sampler.Locate(7.5f, 7.5f, 6.5f)).has_distance);
    const BlockId id = map_.Find({0, 0, 0});
    map_.field(id)[3 + 8 * 3 + 64 * 3] &= 0xffff0000u;  // no intensity
    const FieldSample grey = sampler.Sample<true>(sampler.Locate(2.5f, 2.5f, 2.5f));
    EXPECT_TRUE(grey.has_distance);
    EXPECT_FALSE(grey.has_intensity);
    EXPECT_FALSE(
        sampler.Sample<false>(sampler.Locate(4.5f, 5.5f, 5.5f)).has_intensity);  // not requested
    map_.field(id)[3 + 8 * 3 + 64 * 3] = kUnknownField | 5;
    EXPECT_FALSE(sampler.Sample<true>(sampler.Locate(2.5f, 2.5f, 2.5f)).has_distance);
}

TEST_F(FieldSamplerTest, FindBlockIsTheMapsFind) {
    for (int i = 0; i < 3000; ++i)
        map_.Allocate({static_cast<int>(Random() * 40) - 20, static_cast<int>(Random() * 40) - 20,
                       static_cast<int>(Random() * 40) - 20});
    const BlockMapView view = map_.view();
    for (int z = -21; z <= 21; ++z)
        for (int y = -21; y <= 21; ++y)
            for (int x = -21; x <= 21; ++x)
                ASSERT_EQ(FindBlock(view, x, y, z), map_.Find({x, y, z}));
}

}  // namespace
}  // namespace tessera
