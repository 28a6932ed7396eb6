#include "tracking/photometry.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <random>

#include "support/box_room.h"

namespace tessera {
namespace {

using namespace testing_support;

// The alpha that is learnt from residuals of a textured room, alpha bounds out of the way.
class LearntAlpha : public testing::Test {
  protected:
    LearntAlpha() {
        PrepareFrame(room_.Render(camera_, Eigen::Isometry3d::Identity()), {}, frame_);
        points_.Build(frame_, camera_, {}, 1, 0.0);
        points_.SampleIntensity(frame_, camera_, {});
        distance_.resize(static_cast<std::size_t>(points_.count()));
        intensity_ = distance_;
        config_.auto_alpha_min = 1e-4;
        config_.auto_alpha_max = 100;
        config_.shading_error = 0;
        std::normal_distribution<float> noise;
        for (float& r : distance_) r = 0.002f * noise(random_);
        for (float& r : intensity_) r = 0.02f * noise(random_);
    }
    double Learn() {
        photometry_.emplace(config_);
        TrackResult result;
        result.degenerate = degenerate_;
        result.alpha = photometry_->alpha();
        result.intensity_rms = 0.02;
        result.motion.twist_per_s << 0, 0.5, 0, 0, 0, 0;
        photometry_->Learn(result, MakeResidualArguments(frame_, camera_, points_, distance_, intensity_), SumResiduals);
        return photometry_->alpha();
    }

    PinholeCamera camera_ = {320, 240, 262.0, 262.0, 159.5, 119.5};
    BoxRoom room_;
    PreparedFrame frame_;
    FramePoints points_;
    std::mt19937 random_{3};
    Photometry::Config config_;
    std::optional<Photometry> photometry_;
    bool degenerate_ = false;
    std::vector<float> distance_, intensity_;
};

// Independent errors: the ratio of the plain variances, 4e-6 m^2 / 4e-4.
TEST_F(LearntAlpha, IsTheRatioOfTheVariances) {
    EXPECT_NEAR(Learn(), 0.01, 0.002);
}

// An explanation of what a pose that is not held got wrong.
TEST_F(LearntAlpha, NothingIsLearntFromDegenerateFrames) {
    config_.alpha = 0.3;
    degenerate_ = true;
    EXPECT_EQ(Learn(), 0.3);
    EXPECT_EQ(photometry_->Timed({}).colour_delay_s, 0);
    degenerate_ = false;
    EXPECT_NE(Learn(), 0.3);
    EXPECT_NE(photometry_->Timed({}).colour_delay_s, 0);
}

// Errors that neighbours share count more the more neighbours share them; here 16 x 16 do.
TEST_F(LearntAlpha, SharedErrorsOfDistancesRaiseIt) {
    std::normal_distribution<float> noise;
    float shared = 0;
    for (int y = 0; y < points_.height(); ++y)
        for (int x = 0; x < points_.width(); ++x) {
            if (x % 16 == 0) shared = 0.002f * noise(random_);
            distance_[static_cast<std::size_t>(y * points_.width() + x)] += shared;
        }
    EXPECT_GT(Learn(), 0.05);
}

// As where edges are blurred or displaced: the errors pull all one way at each edge, though their sum is zero.
TEST_F(LearntAlpha, ErrorsAlongTheGradientLowerIt) {
    const double before = Learn();
    for (int y = 0; y < points_.height(); ++y)
        for (int x = 1; x + 1 < points_.width(); ++x) {
            const std::size_t i = static_cast<std::size_t>(y * points_.width() + x);
            intensity_[i] += (y / 16 + x / 16) % 2 == 0 ? points_.intensity[i + 1] - points_.intensity[i - 1]
                                                       : points_.intensity[i - 1] - points_.intensity[i + 1];
        }
    EXPECT_LT(Learn(), 0.3 * before);
}

// The same gradient everywhere, up and down by turns or only up: what a tile is wrong by together cancels, or counts 256 times.
TEST_F(LearntAlpha, ShadingErrorLowersItWhereShadingIsTheOnlyTexture) {
    config_.shading_error = 0.02;
    config_.auto_alpha_min = 1e-6;
    const auto learn_from = [&](const auto& intensity_of) {
        for (int i = 0; i < points_.count(); ++i) {
            points_.z[static_cast<std::size_t>(i)] = 1;
            points_.intensity[static_cast<std::size_t>(i)] = 0.001f * static_cast<float>(intensity_of(i % points_.width()));
        }
        return Learn();
    };
    EXPECT_NEAR(learn_from([](int x) { return std::abs(x % 16 - 8); }), 4e-6 / 4e-4, 0.003);
    EXPECT_NEAR(learn_from([](int x) { return x; }), 4e-6 / (4e-4 + 256 * 4e-4), 5e-6);
}

TEST_F(LearntAlpha, StaysWithinItsBoundsAndWhereItIsFixed) {
    config_.auto_alpha_min = 0.1;
    EXPECT_DOUBLE_EQ(Learn(), 0.1);
    config_.auto_alpha_min = 1e-4;
    config_.auto_alpha_max = 0.001;
    EXPECT_DOUBLE_EQ(Learn(), 0.001);
    config_.alpha_mode = Photometry::AlphaMode::kFixed;
    EXPECT_DOUBLE_EQ(Learn(), config_.alpha);
    Photometry photometry(config_);
    photometry.SetAlpha(false, 0.25);
    EXPECT_DOUBLE_EQ(photometry.alpha(), 0.25);
}

}  // namespace
}  // namespace tessera
