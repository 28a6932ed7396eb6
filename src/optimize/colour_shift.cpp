#include "optimize/colour_shift.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

constexpr int kShiftColumns = 320;  // of the images that are compared
constexpr float kNearestEdge_m = 0.3f, kFarthestEdge_m = 4;
// What lies behind an edge is farther by more than this share, and at most so many columns away; a
// shadow may lie between. In front of the edge the surface goes on for some columns.
constexpr float kStep = 1.08f, kLevel = 0.03f;
constexpr int kShadow = 12, kSurface = 3;
constexpr int kMostEdges = 1000, kFewestEdges = 200;  // per direction: of a frame, of all frames
constexpr float kWeakEdge = 4;                        // grey levels per column that count half
constexpr int kParts = 8;
// The best shift is so many standard deviations of the search better than a typical one.
constexpr double kContrast = 3;
constexpr double kShiftDeviations = 6;
// Shares of the width. Where the registration is right, estimates are up to 0.5 % off
// (docs/benchmarks/calibration.md).
constexpr double kFloor = 0.01, kFloorOfGuess = 0.005;

constexpr std::array<std::pair<int, int>, 4> kAhead = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

// Every step-th pixel. Luma is smoothed before by 1-2-1 in both directions.
struct SmallView {
    DepthImage depth_m;
    Image<float> luma;
};

SmallView Shrink(const Frame& frame, int step) {
    const int width = frame.depth_m.width() / step, height = frame.depth_m.height() / step;
    const auto luma = [&](int x, int y) {
        const Rgb8 c = frame.colour(std::clamp(x, 0, frame.colour.width() - 1),
                                    std::clamp(y, 0, frame.colour.height() - 1));
        return 0.299f * static_cast<float>(c.r) + 0.587f * static_cast<float>(c.g) +
               0.114f * static_cast<float>(c.b);
    };
    SmallView view{DepthImage(width, height), Image<float>(width, height)};
    constexpr std::array<float, 3> kWeights = {0.25f, 0.5f, 0.25f};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int u = x * step + step / 2, v = y * step + step / 2;
            view.depth_m(x, y) = frame.depth_m(u, v);
            float sum = 0;
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i)
                    sum += kWeights[static_cast<std::size_t>(i + 1)] *
                           kWeights[static_cast<std::size_t>(j + 1)] * luma(u + i, v + j);
            view.luma(x, y) = sum;
        }
    return view;
}

// Strength of luma's edges across `dx`, `dy`, from 0 to 1. 0 at the border.
Image<float> EdgeStrength(const Image<float>& luma, int dx, int dy) {
    Image<float> strength(luma.width(), luma.height());
    for (int y = 1; y < luma.height() - 1; ++y)
        for (int x = 1; x < luma.width() - 1; ++x) {
            const float slope = std::abs(luma(x + dx, y + dy) - luma(x - dx, y - dy)) / 2;
            strength(x, y) = slope / (slope + kWeakEdge);
        }
    return strength;
}

// Whether a near surface ends at (x, y) in this direction: it goes on behind, and the next depth
// ahead is clearly farther. (x, y) is at least kShadow pixels away from the border.
bool EndsAt(const DepthImage& depth_m, int x, int y, int dx, int dy) {
    const float z_m = depth_m(x, y);
    if (!(z_m > kNearestEdge_m) || !(z_m < kFarthestEdge_m)) return false;
    for (int k = 1; k <= kSurface; ++k)
        if (!(std::abs(depth_m(x - k * dx, y - k * dy) - z_m) < kLevel * z_m)) return false;
    for (int k = 1; k <= kShadow; ++k)
        if (const float ahead_m = depth_m(x + k * dx, y + k * dy); ahead_m > 0)
            return ahead_m > kStep * z_m;
    return false;
}

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

void ColourShiftEstimator::Add(const Frame& frame) {
    if (frame.colour.empty() || frame.colour.width() != frame.depth_m.width()) return;
    step_px_ = std::max(1, frame.depth_m.width() / kShiftColumns);
    width_px_ = frame.depth_m.width();
    const SmallView view = Shrink(frame, step_px_);
    const int width = view.luma.width(), height = view.luma.height();
    constexpr int kBorder = kRadius + 1;
    static_assert(kBorder > kShadow);
    const Image<float> across = EdgeStrength(view.luma, 1, 0), down = EdgeStrength(view.luma, 0, 1);
    Evidence evidence;
    for (std::size_t d = 0; d < kDirections; ++d) {
        const auto [dx, dy] = kAhead[d];
        std::vector<std::pair<int, int>> ends;
        for (int y = kBorder; y < height - kBorder; ++y)
            for (int x = kBorder; x < width - kBorder; ++x)
                if (EndsAt(view.depth_m, x, y, dx, dy)) ends.emplace_back(x, y);
        const std::size_t every = 1 + ends.size() / kMostEdges;
        const Image<float>& strength = dx != 0 ? across : down;
        for (std::size_t e = 0; e < ends.size(); e += every) {
            const auto [x, y] = ends[e];
            float* sum = evidence.strength[d].data();
            for (int j = -kRadius; j <= kRadius; ++j) {
                const float* row = strength.row(y + j) + x - kRadius;
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
