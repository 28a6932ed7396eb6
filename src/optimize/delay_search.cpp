#include "optimize/delay_search.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

// Where the parabola through three values has its top, in steps from the middle one.
double TopOf(double before, double middle, double after) {
    const double bend = before - 2 * middle + after;
    return bend < 0 ? 0.5 * (before - after) / bend : 0;
}

// Between two rows of the table, linear.
std::optional<DelayPeak> BestAt(const DelayScores& scores, double readout_s) {
    const double row = std::clamp(readout_s / SearchedReadout_s(kReadouts / 2 + 1) + kReadouts / 2,
                                  0.0, kReadouts - 1.0);
    const int above = std::min(static_cast<int>(row), kReadouts - 2);
    std::array<double, kDelays> between{};
    for (std::size_t k = 0; k < between.size(); ++k) {
        const std::size_t at = static_cast<std::size_t>(above * kDelays) + k;
        between[k] = std::lerp(scores[at], scores[at + kDelays], row - above);
    }
    const auto best = std::ranges::max_element(between);
    const auto k = best - between.begin();
    if (k == 0 || k == kDelays - 1) return std::nullopt;
    const double top = static_cast<double>(k) + TopOf(best[-1], *best, best[1]);
    return DelayPeak{SearchedDelay_s(top), readout_s, *best};
}

}  // namespace

std::optional<DelayPeak> BestOfAllReadouts(const DelayScores& scores) {
    const auto best = std::ranges::max_element(scores);
    const auto at = static_cast<int>(best - scores.begin());
    const int k = at % kDelays, r = at / kDelays;
    if (k == 0 || r == 0 || k == kDelays - 1 || r == kReadouts - 1) return std::nullopt;
    return DelayPeak{SearchedDelay_s(k + TopOf(best[-1], *best, best[1])),
                     SearchedReadout_s(r + TopOf(best[-kDelays], *best, best[kDelays])), *best};
}

std::optional<DelayPeak> BestOfTwoReadouts(const DelayScores& scores, double colour_readout_s) {
    const std::optional<DelayPeak> rolls = BestAt(scores, 0),
                                   at_once = BestAt(scores, colour_readout_s);
    if (!rolls || !at_once) return std::nullopt;
    return rolls->score >= at_once->score ? rolls : at_once;
}

}  // namespace tessera
