#include "optimize/rigid_fit.h"

#include <gtest/gtest.h>

#include <random>

#include "core/se3.h"
#include "optimize/feature_match.h"

namespace tessera {
namespace {

class Pairs : public testing::Test {
  protected:
    // `right` exact pairs and `wrong` random ones, mixed.
    void Make(int right, int wrong) {
        std::uniform_real_distribution<float> side(-1, 1), depth(1, 3);
        for (int i = 0; i < right + wrong; ++i) {
            const Eigen::Vector3f p(side(random), side(random), depth(random));
            b.push_back(p);
            const bool is_right =
                i % (right + wrong) * right / (right + wrong) != (i + 1) * right / (right + wrong);
            a.push_back(is_right ? Eigen::Vector3f(T.cast<float>() * p)
                                 : Eigen::Vector3f(side(random), side(random), depth(random)));
        }
    }
    std::mt19937 random{3};
    Vector6d twist = (Vector6d() << 0.3, -0.2, 0.4, 0.5, -0.1, 0.2).finished();
    Eigen::Isometry3d T = Se3Exp(twist);
    std::vector<Eigen::Vector3f> a, b;
};

TEST_F(Pairs, WithoutOutliersTheMotionIsExact) {
    Make(10, 0);
    EXPECT_TRUE(FitAll(a, b).isApprox(T, 1e-6));
}

TEST_F(Pairs, SixtyPerCentWrongDoNoHarm) {
    Make(40, 60);
    const RigidFit fit = FitRigid(a, b, 0.02);
    EXPECT_GE(fit.inliers.size(), 40u);
    EXPECT_LE(fit.inliers.size(), 42u);
    EXPECT_LT(Se3Log(fit.T_a_b.inverse() * T).norm(), 2e-3);
    EXPECT_GT(fit.spread_m, 0.4);
}

TEST_F(Pairs, OnlyWrongOnesFitNothing) {
    Make(0, 60);
    EXPECT_LT(FitRigid(a, b, 0.02).inliers.size(), 8u);
}

TEST_F(Pairs, PointsOnALineHaveNoSpread) {
    for (int i = 0; i < 20; ++i) {
        b.emplace_back(0.1f * static_cast<float>(i), 0.0f, 2.0f);
        a.push_back(T.cast<float>() * b.back());
    }
    EXPECT_LT(FitRigid(a, b, 0.02).spread_m, 1e-3);
}

TEST_F(Pairs, TooFewAreNoFit) {
    Make(2, 0);
    EXPECT_TRUE(FitRigid(a, b, 0.02).inliers.empty());
}

TEST_F(Pairs, FeaturesMatchOnlyWithEnoughOfThem) {
    Make(30, 0);
    Features old, fresh;
    std::mt19937_64 bits(9);
    for (std::size_t i = 0; i < a.size(); ++i) {
        old.descriptors.push_back({bits(), bits(), bits(), bits()});
        old.p_camera.push_back(a[i]);
    }
    fresh.descriptors.assign(old.descriptors.rbegin(), old.descriptors.rend());
    fresh.p_camera.assign(b.rbegin(), b.rend());
    LoopConfig config;
    config.min_inliers = 30;
    const std::optional<Eigen::Isometry3d> T_old_new = MatchFeatures(old, fresh, config);
    ASSERT_TRUE(T_old_new);
    EXPECT_TRUE(T_old_new->isApprox(T, 1e-5));
    config.min_inliers = 31;
    EXPECT_FALSE(MatchFeatures(old, fresh, config));
    config.min_inliers = 10;
    config.min_spread_m = 5;
    EXPECT_FALSE(MatchFeatures(old, fresh, config));
}

// 64 features spread evenly over a flat surface that fills the view of a Kinect; its height is
// `share` of the view's.
bool FlatSurfaceMatches(float depth_m, float share) {
    const Eigen::Isometry3d T = Se3Exp((Vector6d() << 0, 0.05, 0, 0.02, 0, 0.01).finished());
    Features old, fresh;
    std::mt19937_64 bits(9);
    for (int i = 0; i < 64; ++i) {
        const float u = static_cast<float>(i % 8) / 8 - 0.4375f,
                    v = static_cast<float>(i / 8) / 8 - 0.4375f;
        old.p_camera.emplace_back(640 * u / 525 * depth_m, share * 480 * v / 525 * depth_m,
                                  depth_m);
        old.descriptors.push_back({bits(), bits(), bits(), bits()});
        fresh.p_camera.push_back(T.inverse().cast<float>() * old.p_camera.back());
    }
    fresh.descriptors = old.descriptors;
    LoopConfig all_of_them;
    all_of_them.min_inliers = 64;
    all_of_them.min_spread_m = 0;
    EXPECT_TRUE(MatchFeatures(old, fresh, all_of_them)) << depth_m << " " << share;
    return MatchFeatures(old, fresh, LoopConfig{}).has_value();
}

// Over the whole view the spread is 0.26 times the depth.
TEST(MatchFeatures, ANearViewNeedsLessSpread) {
    EXPECT_TRUE(FlatSurfaceMatches(0.4f, 1));
    EXPECT_TRUE(FlatSurfaceMatches(0.4f, 0.5f));
    EXPECT_FALSE(FlatSurfaceMatches(0.4f, 0.4f));
    EXPECT_TRUE(FlatSurfaceMatches(1.5f, 0.35f));
    EXPECT_FALSE(FlatSurfaceMatches(1.5f, 0.25f));
}

TEST(MatchDescriptors, AreMutualAndClear) {
    const Descriptor x{1}, y{~std::uint64_t{0}, ~std::uint64_t{0}};
    const std::vector<Descriptor> old{x, y}, twice{x, x}, fresh{y, x};
    EXPECT_EQ(MatchDescriptors(old, fresh), (std::vector<std::pair<int, int>>{{0, 1}, {1, 0}}));
    EXPECT_TRUE(MatchDescriptors(old, twice).empty());  // ambiguous: two equal candidates
}

}  // namespace
}  // namespace tessera
