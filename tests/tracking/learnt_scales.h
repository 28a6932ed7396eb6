// What the residual model learns from the residuals of a textured room.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

#include "support/box_room.h"
#include "tracking/residual_model.h"

namespace tessera {

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

}  // namespace tessera
