#include "optimize/colour_shift.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

constexpr int kFewestEdges = 200;  // per direction, of all frames
constexpr int kParts = 8;
// The best shift is so many standard deviations of the search better than a typical one.
constexpr double kContrast = 3;
constexpr double kShiftDeviations = 6;
// Shares of the width. Where the registration is right, estimates are up to 0.5 % off
// (docs/benchmarks/calibration.md).
constexpr double kFloor = 0.01, kFloorOfGuess = 0.005;

}  // namespace

bool ColourShift::shown() const {
    const double floor_px = (known ? kFloor : kFloorOfGuess) * width_px;
    return std::abs(x_px) > std::max(kShiftDeviations * sigma_x_px, floor_px) ||
           std::abs(y_px) > std::max(kShiftDeviations * sigma_y_px, floor_px);
}

std::string ColourShiftText(const ColourShift& s) {
    return fmt::format(
        "colour lies {:.1f} +- {:.1f} px {} and {:.1f} +- {:.1f} px {} where depth puts it",
        std::abs(s.x_px), s.sigma_x_px, s.x_px > 0 ? "right of" : "left of", std::abs(s.y_px),
        s.sigma_y_px, s.y_px > 0 ? "below" : "above");
}

void ColourShiftEstimator::Evidence::Add(const Evidence& other) {
    for (std::size_t d = 0; d < kDirections; ++d) {
        edges[d] += other.edges[d];
        for (std::size_t i = 0; i < strength[d].size(); ++i) strength[d][i] += other.strength[d][i];
    }
}

void ColourShiftEstimator::Add(const EdgeView& view) {
    if (view.empty()) return;
    static_assert(kRadius < EdgeView::kBorder);
    step_px_ = view.step_px;
    width_px_ = view.across.width() * view.step_px;
    Evidence evidence;
    for (std::size_t d = 0; d < kDirections; ++d) {
        const Image<float>& strength = view.Strength(d);
        for (const EdgeView::End& end : view.ends[d]) {
            float* sum = evidence.strength[d].data();
            for (int j = -kRadius; j <= kRadius; ++j) {
                const float* row = strength.row(end.y + j) + end.x - kRadius;
                for (int i = 0; i < kSide; ++i) *sum++ += row[i];
            }
            ++evidence.edges[d];
        }
    }
    frames_.push_back(evidence);
}

std::optional<ColourShiftEstimator::Peak> ColourShiftEstimator::Best(const Evidence& evidence) {
    std::array<double, kSide * kSide> score{};
    for (std::size_t d = 0; d < kDirections; ++d) {
        if (evidence.edges[d] < kFewestEdges) return std::nullopt;
        for (std::size_t i = 0; i < score.size(); ++i)
            score[i] += evidence.strength[d][i] / static_cast<double>(evidence.edges[d]);
    }
    const auto best = static_cast<int>(std::ranges::max_element(score) - score.begin());
    const int x = best % kSide, y = best / kSide;
    if (x == 0 || y == 0 || x == kSide - 1 || y == kSide - 1) return std::nullopt;
    double mean = 0, squares = 0;
    for (const double s : score) mean += s / score.size();
    for (const double s : score) squares += (s - mean) * (s - mean) / score.size();
    const double highest = score[static_cast<std::size_t>(best)];
    if (!(highest - mean > kContrast * std::sqrt(squares))) return std::nullopt;
    // The top of the parabola through three values.
    const auto between = [&](int apart) {
        const double before = score[static_cast<std::size_t>(best - apart)],
                     after = score[static_cast<std::size_t>(best + apart)],
                     bend = before - 2 * highest + after;
        return bend < 0 ? 0.5 * (before - after) / bend : 0;
    };
    return Peak{x - kRadius + between(1), y - kRadius + between(kSide)};
}

std::optional<ColourShift> ColourShiftEstimator::Estimate() const {
    if (frames_.size() < kParts) return std::nullopt;
    Evidence all;
    for (const Evidence& frame : frames_) all.Add(frame);
    const std::optional<Peak> best = Best(all);
    if (!best) return std::nullopt;
    double mean_x = 0, mean_y = 0, square_x = 0, square_y = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
        Evidence rest;
        for (std::size_t i = 0; i < frames_.size(); ++i)
            if (i * kParts / frames_.size() != part) rest.Add(frames_[i]);
        const std::optional<Peak> without = Best(rest);
        if (!without) return std::nullopt;
        mean_x += without->x / kParts;
        mean_y += without->y / kParts;
        square_x += without->x * without->x / kParts;
        square_y += without->y * without->y / kParts;
    }
    // Jackknife.
    const auto sigma_px = [&](double square, double mean) {
        return step_px_ * std::sqrt((kParts - 1) * std::max(0.0, square - mean * mean));
    };
    ColourShift shift;
    shift.x_px = step_px_ * best->x;
    shift.y_px = step_px_ * best->y;
    shift.sigma_x_px = sigma_px(square_x, mean_x);
    shift.sigma_y_px = sigma_px(square_y, mean_y);
    shift.width_px = width_px_;
    shift.frames = static_cast<int>(frames_.size());
    return shift;
}

}  // namespace tessera
