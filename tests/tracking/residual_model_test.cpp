#include "tracking/residual_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "tracking/learnt_scales.h"

namespace tessera {
namespace {

// For independent errors: the plain variances, 4e-6 m^2 and 4e-4, and their ratio.
TEST_F(LearntScales, AreTheVariancesOfIndependentErrors) {
    const ResidualScales scales = Learn();
    EXPECT_NEAR(scales.distance_m2, 4e-6, 1.5e-6);
    EXPECT_NEAR(scales.intensity, 4e-4, 2e-4);
    EXPECT_NEAR(model_->alpha(), 0.01, 0.007);
}

// An object in a small part of the image is seen by itself.
TEST_F(LearntScales, ASmallObjectTeachesThem) {
    for (int y = 0; y < points_.height(); ++y)
        for (int x = 0; x < points_.width(); ++x)
            if (x > points_.width() / 6 || y > points_.height() / 4)
                residuals_.distance_m[Index(x, y)] = residuals_.intensity[Index(x, y)] = NAN;
    const ResidualScales scales = Learn();
    EXPECT_NEAR(scales.distance_m2, 4e-6, 2.5e-6);
    EXPECT_NEAR(scales.intensity, 4e-4, 3e-4);
}

TEST_F(LearntScales, NothingTeachesNothing) {
    for (float& r : residuals_.distance_m) r = NAN;
    EXPECT_EQ(Learn().distance_m2, 0);
}

// Errors shared by neighbours count more the more neighbours share them. Here 32 x 32 points do,
// about half a region across.
TEST_F(LearntScales, GrowWithErrorsThatNeighboursShare) {
    const double alone = Learn().distance_m2;
    std::normal_distribution<float> noise;
    float shared[8][10];
    for (auto& row : shared)
        for (float& s : row) s = 0.002f * noise(random_);
    for (int y = 0; y < points_.height(); ++y)
        for (int x = 0; x < points_.width(); ++x)
            residuals_.distance_m[Index(x, y)] += shared[y / 32][x / 32];
    EXPECT_GT(Learn().distance_m2, 50 * alone);
}

// As at blurred or displaced edges: the errors at each edge all pull in one direction, though their
// sum is zero.
TEST_F(LearntScales, ErrorsAlongTheImageGradientCountAsTheyPull) {
    const double before = Learn().intensity;
    for (int y = 0; y < points_.height(); ++y)
        for (int x = 1; x + 1 < points_.width(); ++x)
            residuals_.intensity[Index(x, y)] +=
                (y / 16 + x / 16) % 2 == 0
                    ? points_.intensity[Index(x + 1, y)] - points_.intensity[Index(x - 1, y)]
                    : points_.intensity[Index(x - 1, y)] - points_.intensity[Index(x + 1, y)];
    EXPECT_GT(Learn().intensity, 3 * before);
}

// All gradients have the same size and either alternate in sign or all point the same way. The
// shading errors of a block cancel, or count 256 times.
TEST_F(LearntScales, ShadingErrorCountsWhereShadingIsTheOnlyTexture) {
    config_.shading_error = 0.02;
    std::ranges::fill(residuals_.intensity, 0.0f);
    residuals_.intensity[Index(3, 3)] = 1e-3f;  // not all zero
    const auto learn_from = [&](const auto& intensity_of) {
        for (int i = 0; i < points_.count(); ++i) {
            points_.z[static_cast<std::size_t>(i)] = 1;
            points_.intensity[static_cast<std::size_t>(i)] =
                0.001f * static_cast<float>(intensity_of(i % points_.width()));
        }
        return Learn().intensity;
    };
    EXPECT_LT(learn_from([](int x) { return std::abs(x % 16 - 8); }), 2e-3);
    EXPECT_NEAR(learn_from([](int x) { return x; }), 256 * 4e-4, 2e-3);
}

// The map is the image plus its own noise, so half of the squared gradients are noise.
TEST_F(LearntScales, NoiseInTheMapIsNoTexture) {
    std::normal_distribution<float> noise;
    for (float& i : points_.intensity) i = 0.5f + 0.05f * noise(random_);
    std::ranges::fill(residuals_.intensity, 0.0f);
    residuals_.intensity[Index(3, 3)] = 1e-3f;
    EXPECT_NEAR(Learn().texture, 1, 0.01);
    for (float& r : residuals_.intensity) r = 0.05f * noise(random_);
    EXPECT_NEAR(Learn().texture, 0.5, 0.05);
    for (int i = 0; i < points_.count(); ++i)  // a map unrelated to the image
        residuals_.intensity[static_cast<std::size_t>(i)] =
            0.05f * noise(random_) - (points_.intensity[static_cast<std::size_t>(i)] - 0.5f);
    EXPECT_LT(Learn().texture, 0.05);
}

// The map has the image's shading and nothing else; the frame is as noisy as bare walls are. What
// pulls are the map's gradients: each block's errors add up, and hide in no noise. The shading that
// the two share confirms nothing.
TEST_F(LearntScales, ABareWallHasNoTexture) {
    config_.shading_error = 0.02;
    std::normal_distribution<float> noise;
    for (int i = 0; i < points_.count(); ++i) {
        const auto at = static_cast<std::size_t>(i);
        points_.z[at] = 1;
        const float shading = 0.2f + 0.001f * static_cast<float>(i % points_.width());
        points_.intensity[at] = shading + 0.01f * noise(random_);
        residuals_.intensity[at] = shading - points_.intensity[at];
    }
    EXPECT_LT(Learn().texture, 0.05);
    EXPECT_NEAR(Learn().intensity, 256 * 4e-4, 5e-3);
}

// Disagreement between the two kinds raises the variance of the kind with less information.
TEST_F(LearntScales, DisagreementIsSharedOut) {
    const double agreed = (Learn(), model_->alpha());
    distances_.H *= 1e3;  // distances dominate
    distances_.g = -distances_.H * Vector6d::Constant(0.05);
    EXPECT_LT((Learn(), model_->alpha()), 0.5 * agreed);
    distances_.H = Matrix6d::Identity();
    distances_.g.setZero();
    intensities_.H *= 1e6;
    intensities_.g = -intensities_.H * Vector6d::Constant(0.05);
    EXPECT_GT((Learn(), model_->alpha()), 2 * agreed);
}

TEST_F(LearntScales, AlphaStaysWithinItsBoundAndWhereItIsFixed) {
    config_.auto_alpha_max = 0.001;
    Learn();
    EXPECT_DOUBLE_EQ(model_->alpha(), 0.001);
    config_.alpha_mode = ResidualModel::AlphaMode::kFixed;
    Learn();
    EXPECT_DOUBLE_EQ(model_->alpha(), config_.alpha);
    model_->SetAlpha(false, 0.25);
    EXPECT_DOUBLE_EQ(model_->alpha(), 0.25);
}

}  // namespace
}  // namespace tessera
