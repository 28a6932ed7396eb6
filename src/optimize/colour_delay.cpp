#include "optimize/colour_delay.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "optimize/delay_search.h"

namespace tessera {
namespace {

constexpr std::size_t kDelayParts = 8;
// Fewer say nothing about how the estimate changes from part to part.
constexpr std::size_t kFewestViews = 3 * kDelayParts;
constexpr std::size_t kMostEnds = 300, kFewestEnds = 200;  // per direction: of a view, of all views
constexpr double kLongestStep_s = 0.25;                    // between views
constexpr double kCertainDeviations = 2;
// Most estimates are right to a millisecond (docs/benchmarks/shutter.md).
constexpr double kLeastDelay_s = 0.002;

constexpr std::size_t kDirections = EdgeView::kAhead.size();

Image<std::uint8_t> Smoothed(const Image<float>& image) {
    Image<std::uint8_t> result(image.width(), image.height());
    for (int y = 1; y < image.height() - 1; ++y)
        for (int x = 1; x < image.width() - 1; ++x) {
            const auto row = [&](int v) {
                return image(x - 1, v) + 2 * image(x, v) + image(x + 1, v);
            };
            result(x, y) = static_cast<std::uint8_t>(
                std::lround(255 * (row(y - 1) + 2 * row(y) + row(y + 1)) / 16));
        }
    return result;
}

// Bilinear; 0 outside.
float At(const Image<std::uint8_t>& image, float x, float y) {
    const auto last_x = static_cast<float>(image.width() - 1),
               last_y = static_cast<float>(image.height() - 1);
    if (!(x >= 0 && y >= 0 && x < last_x && y < last_y)) return 0;
    const int i = static_cast<int>(x), j = static_cast<int>(y);
    const float a = x - static_cast<float>(i), b = y - static_cast<float>(j);
    const auto between = [&](const std::uint8_t* row) {
        return (1 - a) * static_cast<float>(row[0]) + a * static_cast<float>(row[1]);
    };
    return (1 - b) * between(image.row(j) + i) + b * between(image.row(j + 1) + i);
}

// How fast an end moves in the view, pixels per second.
Eigen::Vector2f Flow(const EdgeView::End& end, int step_px, const PinholeCamera& camera,
                     const Vector6d& velocity) {
    const Eigen::Vector3d p =
        camera.Unproject(end.x * step_px + step_px / 2, end.y * step_px + step_px / 2, end.depth_m);
    const Eigen::Vector3d v = -(velocity.head<3>().cross(p) + velocity.tail<3>()) / p.z();
    return {static_cast<float>(camera.fx * (v.x() - p.x() / p.z() * v.z()) / step_px),
            static_cast<float>(camera.fy * (v.y() - p.y() / p.z() * v.z()) / step_px)};
}

}  // namespace

struct ColourDelayEstimator::Evidence {
    std::array<DelayScores, kDirections> strength{};
    std::array<double, kDirections> ends{};

    void Add(const Evidence& other) {
        for (std::size_t d = 0; d < kDirections; ++d) {
            ends[d] += other.ends[d];
            for (std::size_t i = 0; i < strength[d].size(); ++i)
                strength[d][i] += other.strength[d][i];
        }
    }

    // Per end; all directions count alike. Nothing if there are too few ends.
    std::optional<DelayScores> MeanScores() const {
        DelayScores scores{};
        bool enough = false;
        for (std::size_t d = 0; d < kDirections; ++d) {
            // A shadow of the depth camera only cancels out against the opposite direction.
            if (std::min(ends[d], ends[d ^ 1]) < kFewestEnds) continue;
            enough = true;
            for (std::size_t i = 0; i < scores.size(); ++i) scores[i] += strength[d][i] / ends[d];
        }
        return enough ? std::optional(scores) : std::nullopt;
    }
};

bool ColourDelay::shown() const { return std::abs(certain_s()) > kLeastDelay_s; }

double ColourDelay::certain_s() const {
    const double size_s = std::abs(delay_s) - kCertainDeviations * delay_sigma_s;
    return std::copysign(std::max(0.0, size_s), delay_s);
}

std::string ColourDelayText(const ColourDelay& d) {
    return fmt::format("colour was taken {:.1f} +- {:.1f} ms {} than its time stamps say",
                       1000 * std::abs(d.delay_s), 1000 * d.delay_sigma_s,
                       d.delay_s > 0 ? "later" : "earlier");
}

ColourDelayEstimator::ColourDelayEstimator(const PinholeCamera& camera)
    : camera_(camera), aligner_({}, camera) {}

void ColourDelayEstimator::Add(const Frame& frame, const EdgeView& edges) {
    if (edges.empty()) return;
    PrepareFrame(frame, {}, prepared_);
    T_last_current_ = aligner_.Align(prepared_, T_last_current_);
    // Smoothed: otherwise edges would be stronger where the place of a pixel's middle is asked for.
    views_.push_back({frame.stamp_s, frame.colour_stamp_s - frame.stamp_s, Se3Log(T_last_current_),
                      edges.step_px, edges.ends, Smoothed(edges.across), Smoothed(edges.down)});
}

void ColourDelayEstimator::AddView(const View& view, const Vector6d& velocity,
                                   Evidence& evidence) const {
    for (std::size_t d = 0; d < kDirections; ++d) {
        const Image<std::uint8_t>& strength =
            EdgeView::kAhead[d].first != 0 ? view.across : view.down;
        const std::size_t every = 1 + view.ends[d].size() / kMostEnds;
        for (std::size_t e = 0; e < view.ends[d].size(); e += every) {
            const EdgeView::End& end = view.ends[d][e];
            const Eigen::Vector2f flow = Flow(end, view.step_px, camera_, velocity);
            // Colour's edge is between the last pixel of the surface and the next one.
            const float x = end.x + 0.5f * static_cast<float>(EdgeView::kAhead[d].first),
                        y = end.y + 0.5f * static_cast<float>(EdgeView::kAhead[d].second);
            const double row = (end.y + 0.5) / strength.height() - 0.5;
            double* sum = evidence.strength[d].data();
            for (int r = 0; r < kReadouts; ++r)
                for (int k = 0; k < kDelays; ++k) {
                    const auto t = static_cast<float>(view.stamped_delay_s + SearchedDelay_s(k) +
                                                      row * SearchedReadout_s(r));
                    *sum++ += At(strength, x + t * flow.x(), y + t * flow.y());
                }
            ++evidence.ends[d];
        }
    }
}

// The twists of a cubic spline through the views' poses. Plain differences would be 20 % too small
// for motions that change at 2 Hz.
std::vector<std::optional<Vector6d>> ColourDelayEstimator::Velocities() const {
    std::vector<std::optional<Vector6d>> velocities(views_.size());
    const auto gap_s = [&](std::size_t i) { return views_[i].stamp_s - views_[i - 1].stamp_s; };
    const auto mean = [&](std::size_t i) { return Vector6d(views_[i].step / gap_s(i)); };
    for (std::size_t first = 0, last; first < views_.size(); first = last + 1) {
        last = first;
        while (last + 1 < views_.size() && gap_s(last + 1) > 0 && gap_s(last + 1) < kLongestStep_s)
            ++last;
        if (last < first + 2) continue;
        // The ends have the mean velocity of their step, and are not used. Between them a
        // tridiagonal system, solved from the front to the back.
        std::vector<double> factors(last - first, 0);
        std::vector<Vector6d> rests(last - first, mean(first + 1));
        for (std::size_t i = first + 1; i < last; ++i) {
            const std::size_t at = i - first;
            const double before = gap_s(i), after = gap_s(i + 1),
                         pivot = 2 * (before + after) - after * factors[at - 1];
            factors[at] = before / pivot;
            rests[at] =
                (3 * (after * mean(i) + before * mean(i + 1)) - after * rests[at - 1]) / pivot;
        }
        Vector6d next = mean(last);
        for (std::size_t i = last - 1; i > first; --i)
            velocities[i] = next = rests[i - first] - factors[i - first] * next;
    }
    return velocities;
}

std::optional<ColourDelay> ColourDelayEstimator::Estimate(
    std::optional<double> colour_readout_s) const {
    const std::vector<std::optional<Vector6d>> velocities = Velocities();
    std::vector<std::size_t> used;
    for (std::size_t i = 0; i < views_.size(); ++i)
        if (velocities[i]) used.push_back(i);
    if (used.size() < kFewestViews) return std::nullopt;
    std::array<Evidence, kDelayParts> parts;
    tbb::parallel_for(std::size_t{0}, kDelayParts, [&](std::size_t part) {
        for (std::size_t i = 0; i < used.size(); ++i)
            if (const View& view = views_[used[i]]; i * kDelayParts / used.size() == part)
                AddView(view, *velocities[used[i]], parts[part]);
    });
    const auto without = [&](std::size_t left_out) -> std::optional<DelayPeak> {
        Evidence rest;
        for (std::size_t part = 0; part < kDelayParts; ++part)
            if (part != left_out) rest.Add(parts[part]);
        const std::optional<DelayScores> scores = rest.MeanScores();
        if (!scores) return std::nullopt;
        return colour_readout_s ? BestOfTwoReadouts(*scores, *colour_readout_s)
                                : BestOfAllReadouts(*scores);
    };
    const std::optional<DelayPeak> all = without(kDelayParts);
    if (!all) return std::nullopt;
    // Jackknife.
    double mean_s = 0, square_s2 = 0;
    for (std::size_t part = 0; part < kDelayParts; ++part) {
        const std::optional<DelayPeak> rest = without(part);
        if (!rest) return std::nullopt;
        mean_s += rest->delay_s / kDelayParts;
        square_s2 += rest->delay_s * rest->delay_s / kDelayParts;
    }
    return ColourDelay{
        .delay_s = all->delay_s,
        .readout_s = all->readout_s,
        .delay_sigma_s = std::sqrt((kDelayParts - 1) * std::max(0.0, square_s2 - mean_s * mean_s)),
        .depth_rolls = colour_readout_s.value_or(0) != 0 && all->readout_s == 0};
}

}  // namespace tessera
