#include "tracking/image_aligner.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/se3.h"
#include "tracking/align_simd.h"
#include "tracking/image_search.h"
#include "tracking/image_system.h"
#include "tracking/point_kernels.h"
#include "tracking/set_view.h"

namespace tessera {
namespace {

constexpr float kIntensityScale = 0.04f, kDepthScale_m = 0.05f, kMostDepthError_m = 0.3f;
constexpr double kUsual = 1.3, kUsualShare = 0.1, kClearlyBetter = 0.7;
// Per level. Motions that the images constrain less well keep the guess.
constexpr double kHeld_m[] = {0.02, 0.01};

}  // namespace

void ImageAligner::Config::Describe(ConfigParameters& p) {
    p.Add("enabled", enabled,
          "align with the previous frame to find another start for the tracker; helps with fast "
          "motion");
    p.Add("iterations", iterations, {1, 100}, "",
          "maximum number of steps on each of the two reduced levels");
    p.Add("starts", starts, {0, 16}, "",
          "number of best matches of an exhaustive search over rotations that are also tried");
}

ImageAligner::ImageAligner(const Config& config, const PinholeCamera& camera, VectorPath path)
    : config_(config), camera_(camera), path_(path) {}

void ImageAligner::Clear() {
    has_last_ = has_current_ = false;
    usual_score_ = 0;
}

PinholeCamera ImageAligner::ReducedCamera(std::size_t level) const {
    const int n = ReductionOf(camera_.width, camera_.height, level);
    return {camera_.width / n, camera_.height / n,           camera_.fx / n,
            camera_.fy / n,    (camera_.cx + 0.5) / n - 0.5, (camera_.cy + 0.5) / n - 0.5};
}

void ImageAligner::SaveState(StateWriter& state) const {
    const bool has_kept = keep_newest_ ? has_current_ : has_last_;
    state.Put(has_kept);
    state.Put(usual_score_);
    if (!has_kept) return;
    for (const Level& level : keep_newest_ ? current_ : last_) {
        state.PutArray(std::span<const float>(level.intensity.data(), level.intensity.size()));
        state.PutArray(std::span<const float>(level.depth_m.data(), level.depth_m.size()));
    }
}

bool ImageAligner::LoadState(StateReader& state) {
    constexpr float kLargestPixel = 1e3f;  // metres, or intensity
    Clear();
    keep_newest_ = true;
    bool has_kept = false;
    if (!state.Get(has_kept) || !state.Get(usual_score_) || !std::isfinite(usual_score_))
        return false;
    if (!has_kept) return true;
    std::vector<float> pixels;
    for (std::size_t i = 0; i < current_.size(); ++i) {
        Level& level = current_[i];
        level.camera = ReducedCamera(i);
        for (Image<float>* image : {&level.intensity, &level.depth_m}) {
            image->Resize(level.camera.width, level.camera.height);
            if (!state.GetArray(pixels) || pixels.size() != image->size() ||
                !std::ranges::all_of(pixels, [](float p) { return std::abs(p) <= kLargestPixel; }))
                return false;
            std::copy(pixels.begin(), pixels.end(), image->data());
        }
        MakePoints(level);
    }
    has_current_ = true;
    return true;
}

// Converts the pixels of `level` to points, to be aligned with the next frame.
void ImageAligner::MakePoints(Level& level) {
    const PinholeCamera& c = level.camera;
    const auto pixels = static_cast<std::size_t>(c.width * c.height);
    for (auto* values : {&level.x, &level.y, &level.z, &level.intensity_of_point})
        values->assign((pixels + kPointPadding - 1) / kPointPadding * kPointPadding, 0.0f);
    std::copy_n(level.intensity.data(), pixels, level.intensity_of_point.begin());
    std::size_t at = 0;
    for (int y = 0; y < c.height; ++y)
        for (int x = 0; x < c.width; ++x, ++at) {
            const float z = level.depth_m(x, y);
            level.x[at] = RaySlope(x, c.cx, c.fx) * z;
            level.y[at] = RaySlope(y, c.cy, c.fy) * z;
            level.z[at] = z;
        }
}

// The residuals of the last frame's points in the current images. Increments multiply
// T_current_last from the left.
ImageSystem ImageAligner::Linearise(const Level& last, const Level& current,
                                    const Eigen::Isometry3d& T_current_last, double offset) const {
    AlignArguments a{};
    SetCamera(current.camera, a);
    SetPose(T_current_last, a);
    a.depth = current.depth_m.data();
    a.intensity = current.intensity.data();
    a.x = last.x.data();
    a.y = last.y.data();
    a.z = last.z.data();
    a.intensity_of_point = last.intensity_of_point.data();
    a.offset = static_cast<float>(offset);
    a.depth_gate_m = kMostDepthError_m;
    a.depth_scale_m = kDepthScale_m;
    a.intensity_scale = kIntensityScale;
    return ImageSystem(
        SumPoints(static_cast<int>(last.x.size()), [&](int first, int last_point, double* sums) {
            TESSERA_SIMD(path_, SumAlignedPoints)(a, first, last_point, sums);
        }));
}

// Gauss-Newton, coarse to fine, from one start; `score` is the mean robust error of the last
// linearisation.
Eigen::Isometry3d ImageAligner::Refine(const Eigen::Isometry3d& T_last_current,
                                       double& score) const {
    Eigen::Isometry3d T_current_last = T_last_current.inverse();
    double offset = 0;
    for (std::size_t level = 0; level < last_.size(); ++level)
        for (int i = 0; i < config_.iterations; ++i) {
            const ImageSystem system =
                Linearise(last_[level], current_[level], T_current_last, offset);
            score = system.Score();
            const ImageSystem::Step step = system.Solve(scene_depth_m_, kHeld_m[level]);
            if (!step.twist.allFinite() || !std::isfinite(step.offset)) {
                score = std::numeric_limits<double>::infinity();
                return T_last_current;
            }
            T_current_last = Se3Exp(step.twist) * T_current_last;
            offset += step.offset;
            if (step.twist.head<3>().norm() < 5e-4 && step.twist.tail<3>().norm() < 5e-4) break;
        }
    return T_current_last.inverse();
}

Eigen::Isometry3d ImageAligner::Align(const PreparedFrame& frame,
                                      const Eigen::Isometry3d& T_last_current_guess) {
    if (!config_.enabled) return T_last_current_guess;
    if (keep_newest_) {
        std::swap(last_, current_);
        has_last_ = has_current_;
    }
    keep_newest_ = true;
    for (std::size_t i = 0; i < current_.size(); ++i) {
        static_cast<PreparedFrame::Reduced&>(current_[i]) = frame.reduced[i];
        current_[i].camera = ReducedCamera(i);
        MakePoints(current_[i]);
    }
    has_current_ = true;
    if (!has_last_) return T_last_current_guess;

    scene_depth_m_ = 0.5 * (frame.nearest_m + frame.farthest_m);
    double score = 0;
    Eigen::Isometry3d best = Refine(T_last_current_guess, score);
    if (score < kUsual * usual_score_) {
        usual_score_ += kUsualShare * (score - usual_score_);
        return best;
    }
    // The score is worse than usual: search farther. A distant start must be clearly better,
    // because a repeating pattern could also match.
    double best_score =
        score < std::numeric_limits<double>::infinity() ? kClearlyBetter * score : score;
    for (const Eigen::Vector3d& turn : SearchRotations(last_[0].intensity, current_[0].intensity,
                                                       current_[0].camera, config_.starts)) {
        Vector6d twist;
        twist << turn, Eigen::Vector3d::Zero();
        const Eigen::Isometry3d refined = Refine(Se3Exp(twist).inverse(), score);
        if (score >= best_score) continue;
        best_score = score;
        best = refined;
    }
    if (best_score < std::numeric_limits<double>::infinity())
        usual_score_ = usual_score_ > 0 ? usual_score_ + kUsualShare * (best_score - usual_score_)
                                        : best_score;
    return best;
}

}  // namespace tessera
