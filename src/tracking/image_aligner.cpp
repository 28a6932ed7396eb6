#include "tracking/image_aligner.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/se3.h"
#include "tracking/image_search.h"
#include "tracking/image_system.h"

namespace tessera {
namespace {

constexpr int kWidths[] = {40, 80};     // 40 x 30 and 80 x 60 from 640 x 480
constexpr int kRowsPerTile = 5;         // fixed, so that sums have a fixed order
constexpr double kIntensityScale = 0.04, kDepthScale_m = 0.05, kMostDepthError_m = 0.3;
constexpr double kUsual = 1.3, kUsualShare = 0.1, kClearlyBetter = 0.7;
constexpr double kHeld_m[] = {0.02, 0.01};  // per level; motions that the images tell less well are left as guessed

struct Sample {
    float value, gx, gy;
};

// Bilinear value and gradient; false at the border or next to a missing pixel (below `least`).
bool Interpolate(const Image<float>& image, double u, double v, float least, Sample& out) {
    if (!(u >= 0 && v >= 0 && u < image.width() - 1 && v < image.height() - 1)) return false;
    const int x = static_cast<int>(u), y = static_cast<int>(v);
    const float a = image(x, y), b = image(x + 1, y), c = image(x, y + 1), d = image(x + 1, y + 1);
    if (std::min({a, b, c, d}) < least) return false;
    const float fu = static_cast<float>(u - x), fv = static_cast<float>(v - y);
    out.gx = (1 - fv) * (b - a) + fv * (d - c);
    out.gy = (1 - fu) * (c - a) + fu * (d - b);
    out.value = (1 - fv) * (a + fu * (b - a)) + fv * (c + fu * (d - c));
    return true;
}

}  // namespace

void ImageAligner::Config::Describe(ConfigParameters& p) {
    p.Add("enabled", enabled, "find a second start for the tracker from the frame before: helps fast motion");
    p.Add("iterations", iterations, {1, 100}, "", "most steps on each of the two reduced levels");
    p.Add("starts", starts, {0, 16}, "", "best matches of an exhaustive search over rotations that are tried, too");
}

ImageAligner::ImageAligner(const Config& config, const PinholeCamera& camera) : config_(config), camera_(camera) {}

void ImageAligner::Clear() {
    has_last_ = false;
    usual_score_ = 0;
}

PinholeCamera ImageAligner::ReducedCamera(int width) const {
    const int n = std::max(1, camera_.width / width);
    return {camera_.width / n,  camera_.height / n,         camera_.fx / n,
            camera_.fy / n,     (camera_.cx + 0.5) / n - 0.5, (camera_.cy + 0.5) / n - 0.5};
}

void ImageAligner::SaveState(StateWriter& state) const {
    state.Put(has_last_);
    state.Put(usual_score_);
    if (!has_last_) return;
    for (const Level& level : current_) {
        state.PutArray(std::span<const float>(level.intensity.data(), level.intensity.size()));
        state.PutArray(std::span<const float>(level.depth_m.data(), level.depth_m.size()));
    }
}

bool ImageAligner::LoadState(StateReader& state) {
    Clear();
    bool has_last = false;
    if (!state.Get(has_last) || !state.Get(usual_score_)) return false;
    if (!has_last) return true;
    current_.resize(std::size(kWidths));
    std::vector<float> pixels;
    for (std::size_t i = 0; i < current_.size(); ++i) {
        Level& level = current_[i];
        level.camera = ReducedCamera(kWidths[i]);
        for (Image<float>* image : {&level.intensity, &level.depth_m}) {
            image->Resize(level.camera.width, level.camera.height);
            if (!state.GetArray(pixels) || pixels.size() != image->size()) return false;
            std::copy(pixels.begin(), pixels.end(), image->data());
        }
    }
    has_last_ = true;
    return true;
}

void ImageAligner::Reduce(const PreparedFrame& frame, std::vector<Level>& levels) const {
    levels.resize(std::size(kWidths));
    for (std::size_t i = 0; i < levels.size(); ++i) {
        Level& level = levels[i];
        level.camera = ReducedCamera(kWidths[i]);
        const PinholeCamera& c = level.camera;
        const int n = camera_.width / c.width;
        level.depth_m.Resize(c.width, c.height);
        level.intensity.Resize(c.width, c.height);
        tbb::parallel_for(0, c.height, [&](int y) {
            for (int x = 0; x < c.width; ++x) {
                level.depth_m(x, y) = frame.depth_m(x * n + n / 2, y * n + n / 2);
                if (!frame.has_colour()) {
                    level.intensity(x, y) = -1.0f;
                    continue;
                }
                float sum = 0;
                for (int v = 0; v < n; ++v)
                    for (int u = 0; u < n; ++u) sum += frame.intensity(x * n + u, y * n + v);
                level.intensity(x, y) = sum / static_cast<float>(n * n);
            }
        });
    }
}

// Residuals of the last frame's points in the current images; increments multiply T_current_last from the left. The
// seventh unknown is an offset of the intensity.
ImageSystem ImageAligner::Linearise(const Level& last, const Level& current,
                                             const Eigen::Isometry3d& T_current_last, double offset) const {
    const PinholeCamera& c = current.camera;
    const int tiles = (last.camera.height + kRowsPerTile - 1) / kRowsPerTile;
    std::vector<ImageSystem> partial(static_cast<std::size_t>(tiles));
    tbb::parallel_for(0, tiles, [&](int tile) {
        ImageSystem& system = partial[static_cast<std::size_t>(tile)];
        const int y_end = std::min(last.camera.height, (tile + 1) * kRowsPerTile);
        for (int y = tile * kRowsPerTile; y < y_end; ++y)
            for (int x = 0; x < last.camera.width; ++x) {
                const float z = last.depth_m(x, y);
                if (z <= 0) continue;
                const Eigen::Vector3d p = T_current_last * last.camera.Unproject(x, y, z);
                if (p.z() < 0.1) continue;
                const Eigen::Vector2d uv = c.Project(p);
                // d(pixel)/d(increment), rows u and v: d(pixel)/dp * [-[p]x, I].
                Eigen::Matrix<double, 2, 6> J;
                const double iz = 1.0 / p.z(), xz = p.x() * iz, yz = p.y() * iz;
                J.row(0) << -c.fx * xz * yz, c.fx * (1 + xz * xz), -c.fx * yz, c.fx * iz, 0, -c.fx * xz * iz;
                J.row(1) << -c.fy * (1 + yz * yz), c.fy * xz * yz, c.fy * xz, 0, c.fy * iz, -c.fy * yz * iz;
                Sample s;
                Vector7d j;
                if (Interpolate(current.intensity, uv.x(), uv.y(), 0.0f, s)) {
                    const double residual = s.value + offset - last.intensity(x, y);
                    j << (s.gx * J.row(0) + s.gy * J.row(1)).transpose(), 1.0;
                    system.Add(j, residual, kIntensityScale);
                }
                if (Interpolate(current.depth_m, uv.x(), uv.y(), 0.05f, s)) {
                    const double residual = s.value - p.z();
                    if (std::abs(residual) > kMostDepthError_m) continue;
                    j << (s.gx * J.row(0) + s.gy * J.row(1)).transpose(), 0.0;
                    j(0) -= p.y();  // dz/d(increment) = (y, -x, 0, 0, 0, 1)
                    j(1) += p.x();
                    j(5) -= 1.0;
                    const double scale = kDepthScale_m * std::max(1.0, static_cast<double>(z));
                    system.Add(j, residual, scale);
                }
            }
    });
    ImageSystem total;
    for (const ImageSystem& system : partial) {
        total.H += system.H;
        total.g += system.g;
        total.error += system.error;
        total.samples += system.samples;
    }
    return total;
}

// Gauss-Newton, coarse to fine, from one start; `score` is the mean robust error of the last linearisation.
Eigen::Isometry3d ImageAligner::Refine(const Eigen::Isometry3d& T_last_current, double& score) const {
    Eigen::Isometry3d T_current_last = T_last_current.inverse();
    double offset = 0;
    for (std::size_t level = 0; level < last_.size(); ++level)
        for (int i = 0; i < config_.iterations; ++i) {
            const ImageSystem system = Linearise(last_[level], current_[level], T_current_last, offset);
            score = system.Score();
            const Vector7d step = system.Step(scene_depth_m_, kHeld_m[level]);
            if (!step.allFinite()) {
                score = std::numeric_limits<double>::infinity();
                return T_last_current;
            }
            T_current_last = Se3Exp(step.head<6>()) * T_current_last;
            offset += step(6);
            if (step.head<3>().norm() < 5e-4 && step.segment<3>(3).norm() < 5e-4) break;
        }
    return T_current_last.inverse();
}

Eigen::Isometry3d ImageAligner::Align(const PreparedFrame& frame, const Eigen::Isometry3d& T_last_current_guess) {
    if (!config_.enabled) return T_last_current_guess;
    std::swap(last_, current_);
    Reduce(frame, current_);
    const bool ready = has_last_;
    has_last_ = true;
    if (!ready) return T_last_current_guess;

    scene_depth_m_ = 0.5 * (frame.nearest_m + frame.farthest_m);
    double score = 0;
    Eigen::Isometry3d best = Refine(T_last_current_guess, score);
    if (score < kUsual * usual_score_) {
        usual_score_ += kUsualShare * (score - usual_score_);
        return best;
    }
    // Not as good as usual: look farther. A far start must be clearly better, or a pattern that repeats would do.
    double best_score = score < std::numeric_limits<double>::infinity() ? kClearlyBetter * score : score;
    for (const Eigen::Vector3d& turn :
         SearchRotations(last_[0].intensity, current_[0].intensity, current_[0].camera, config_.starts)) {
        Vector6d twist;
        twist << turn, Eigen::Vector3d::Zero();
        const Eigen::Isometry3d refined = Refine(Se3Exp(twist).inverse(), score);
        if (score >= best_score) continue;
        best_score = score;
        best = refined;
    }
    if (best_score < std::numeric_limits<double>::infinity())
        usual_score_ = usual_score_ > 0 ? usual_score_ + kUsualShare * (best_score - usual_score_) : best_score;
    return best;
}

}  // namespace tessera
