// What the residual model learns from colours, and when it takes them for another scene's.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tracking/learnt_scales.h"

namespace tessera {
namespace {

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
