#include "tracking/residual_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>

#include "support/box_room.h"
#include "tracking/pose_information.h"

namespace tessera {
namespace {

using namespace testing_support;

// Scales learnt from the residuals of a textured room, with bounds that have no effect. The
// gradients vary in direction, so all points determine all motions.
class LearntScales : public testing::Test {
  protected:
    LearntScales() {
        PrepareFrame(room_.Render(camera_, Eigen::Isometry3d::Identity()), {}, frame_);
        points_.Build(MakePointArguments(frame_, camera_, {}, 1, {}, true));
        residuals_.Resize(points_.count());
        config_.auto_alpha_max = 100;
        config_.shading_error = config_.surface_error_voxels = 0;
        std::normal_distribution<float> noise;
        for (float& r : residuals_.distance_m) r = 0.002f * noise(random_);
        for (float& r : residuals_.intensity) r = 0.02f * noise(random_);
        for (auto& values : residuals_.gradient)
            for (int y = 0; y < points_.height(); ++y)
                for (int x = 0; x < points_.width(); ++x)
                    values[Index(x, y)] = static_cast<float>(std::sin(
                        0.03 * x + 0.05 * y + double(&values - residuals_.gradient.data())));
        distances_.H = intensities_.H = Matrix6d::Identity();
        distances_.g = intensities_.g = Vector6d::Zero();
    }
    std::size_t Index(int x, int y) const {
        return static_cast<std::size_t>(y * points_.width() + x);
    }

    ResidualSums Sums() {
        arguments_ = MakeResidualArguments(frame_, camera_, points_, residuals_);
        arguments_.gain = 1;
        arguments_.distance_scale_m = arguments_.intensity_scale = 10;
        arguments_.rotation[0] = arguments_.rotation[4] = arguments_.rotation[8] = 1;
        arguments_.has_intensity = true;
        return SumResiduals(arguments_);
    }
    const ResidualScales& Learn() {
        model_.emplace(config_);
        const ResidualSums sums = Sums();
        model_->LearnScales({arguments_, sums, distances_, intensities_, 2.0, 0.01});
        return model_->scales();
    }

    PinholeCamera camera_ = {320, 240, 262.0, 262.0, 159.5, 119.5};
    BoxRoom room_;
    PreparedFrame frame_;
    FramePoints points_;
    std::mt19937 random_{3};
    ResidualModel::Config config_;
    std::optional<ResidualModel> model_;
    ResidualArguments arguments_{};
    PointResiduals residuals_;
    PoseTerm distances_, intensities_;
};

// For independent errors: the plain variances, 4e-6 m^2 and 4e-4, and their ratio.
TEST_F(LearntScales, AreTheVariancesOfIndependentErrors) {
    const ResidualScales scales = Learn();
    EXPECT_NEAR(scales.distance_m2, 4e-6, 1.5e-6);
    EXPECT_NEAR(scales.intensity, 4e-4, 2e-4);
    EXPECT_NEAR(model_->alpha(), 0.01, 0.007);
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

// An image that contradicts the map shows none of its contrast, with errors twice as large as
// usual. Errors alone may be those of a person, no contrast that of a bare wall.
TEST_F(LearntScales, AnImageOfSomethingElseContradicts) {
    config_.doubt_contrast = 0.25;
    model_.emplace(config_);
    const double usual_rms = 0.02;
    const ResidualSums fits = Sums();
    // The map is residual + image: here it is an image of ripples, of which the frame shows
    // nothing.
    for (int y = 0; y < points_.height(); ++y)
        for (int x = 0; x < points_.width(); ++x) {
            residuals_.intensity[Index(x, y)] =
                static_cast<float>(0.2 * std::sin(0.9 * x) * std::sin(0.7 * y));
            points_.intensity[Index(x, y)] = 0.5f;
        }
    frame_.intensity = Image<float>(camera_.width, camera_.height, 0.5f);
    const ResidualSums blank = Sums();
    EXPECT_FALSE(model_->Contradicts(blank, 5 * usual_rms));  // nothing is usual yet
    TrackResult usual;
    usual.intensity_rms = usual_rms;
    model_->LearnColour(usual, fits);
    EXPECT_FALSE(model_->Contradicts(blank, 1.9 * usual_rms));
    EXPECT_TRUE(model_->Contradicts(blank, 2.1 * usual_rms));
    EXPECT_TRUE(model_->Contradicts(blank, 1.9 * usual_rms));  // after a contradiction
    EXPECT_FALSE(model_->Contradicts(fits, 5 * usual_rms));
    EXPECT_FALSE(model_->Contradicts(blank, 1.9 * usual_rms));
    model_->Reset();
    EXPECT_FALSE(model_->Contradicts(blank, 2.1 * usual_rms));

    config_.doubt_contrast = 0;  // off, even if the frame shows the opposite of the map
    model_.emplace(config_);
    model_->LearnColour(usual, fits);
    std::ranges::transform(residuals_.intensity, residuals_.intensity.begin(),
                           [](float r) { return 2 * r; });
    for (int y = 0; y < points_.height(); ++y)
        for (int x = 0; x < points_.width(); ++x)
            points_.intensity[Index(x, y)] = 0.5f - residuals_.intensity[Index(x, y)] / 2;
    EXPECT_FALSE(model_->Contradicts(Sums(), 2.1 * usual_rms));
    EXPECT_FALSE(model_->Contradicts(blank, 2.1 * usual_rms));
}

// On a wall with hardly any texture shading is most of the error, so what is usual contains it.
TEST_F(LearntScales, UsualErrorsContainTheirShading) {
    const auto of_rms = [](double rms) {
        PoseSums sums;
        sums.value[SumLayout::kIntensityWeight] = 50;
        sums.value[SumLayout::kIntensityError] = 50 * rms * rms;
        return sums;
    };
    const ResidualSums fits = Sums();
    TrackResult result;
    result.intensity_rms = 0.003;  // what is left
    model_.emplace(config_);
    EXPECT_TRUE(model_->TakesForShading(of_rms(0.5)));  // nothing is usual yet
    model_->LearnColour(result, fits, 0.01);
    EXPECT_TRUE(model_->TakesForShading(of_rms(0.019)));
    EXPECT_FALSE(model_->TakesForShading(of_rms(0.021)));

    model_.emplace(config_);  // a frame whose shading was not removed
    model_->LearnColour(result, fits);
    EXPECT_TRUE(model_->TakesForShading(of_rms(0.0059)));
    EXPECT_FALSE(model_->TakesForShading(of_rms(0.0061)));

    config_.remove_shading = false;
    model_.emplace(config_);
    EXPECT_FALSE(model_->TakesForShading(of_rms(0.001)));
}

// Where the pose is undetermined, it absorbs errors that are not its own.
TEST_F(LearntScales, DegenerateFramesTeachNothingAboutTheShutter) {
    ResidualSums sums = Sums();
    arguments_.wants_shutter = true;
    arguments_.residual_scale = 0.02;
    arguments_.twist_per_s[1] = 0.5;
    sums.shutter = SumResiduals(arguments_).shutter;
    TrackResult result;
    result.intensity_rms = 0.02;
    model_.emplace(config_);
    result.degenerate = true;
    model_->LearnColour(result, sums);
    EXPECT_EQ(model_->Timed({}).colour_delay_s, 0);
    result.degenerate = false;
    model_->LearnColour(result, sums);
    EXPECT_NE(model_->Timed({}).colour_delay_s, 0);
}

}  // namespace
}  // namespace tessera
