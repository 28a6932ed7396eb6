// Finds colour's delay and read-out time in a table of how well edges meet for each of both.
#pragma once

#include <array>
#include <optional>

namespace tessera {

// Up to 40 ms either way.
inline constexpr int kDelays = 81, kReadouts = 9;
inline constexpr double SearchedDelay_s(double k) { return (k - kDelays / 2) * 0.001; }
inline constexpr double SearchedReadout_s(double r) { return (r - kReadouts / 2) * 0.01; }

// The larger, the better edges meet. Delay k, colour's read-out time less depth's r: at
// r * kDelays + k.
using DelayScores = std::array<double, kDelays * kReadouts>;

struct DelayPeak {
    double delay_s = 0, readout_s = 0, score = 0;
};

// Nothing if the best is at the end of the search.
std::optional<DelayPeak> BestOfAllReadouts(const DelayScores& scores);

// The better of two: depth is read row by row, as colour is in this time, or all at once. Nothing
// if the best delay of one is at the end of the search.
std::optional<DelayPeak> BestOfTwoReadouts(const DelayScores& scores, double colour_readout_s);

}  // namespace tessera
