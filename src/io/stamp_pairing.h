// Pairs colour and depth images by time stamp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace tessera {

struct StampPair {
    std::size_t depth = 0, colour = 0;  // indices into the two lists
};

// Like associate.py of the TUM tools: takes the closest of all pairs less than max_gap_s apart,
// then the closest of the rest, and so on. Each image is used once. Ties are broken by the earlier
// colour stamp, then the earlier depth stamp. The result is sorted by depth stamp. Both lists must
// be strictly increasing and finite. O(n log n), however dense the stamps are. Thread-safe.
// `colour_delay_s`: colour was taken so much later than its stamps say. Images that were taken at
// nearly the same time are paired; max_gap_s becomes greater by it, so that no image is without a
// partner only for that.
std::vector<StampPair> PairNearest(std::span<const double> depth_stamps_s,
                                   std::span<const double> colour_stamps_s, double max_gap_s,
                                   double colour_delay_s = 0);

// How far apart the stamps of a pair may be: max_gap_s, or if that is 0, what lets cameras pair
// that are not synchronised: half of the median time between the images of the slower one, at least
// 20 ms and at most 50 ms. Both lists as for PairNearest. Thread-safe.
double PairGap(double max_gap_s, std::span<const double> depth_stamps_s,
               std::span<const double> colour_stamps_s);

// Whether the two images of every pair (depth_stamp_s, colour_stamp_s) have one stamp.
template <class Pairs>
bool ShareStamps(const Pairs& pairs) {
    return std::ranges::all_of(
        pairs, [](const auto& pair) { return pair.depth_stamp_s == pair.colour_stamp_s; });
}

// The smallest distance between a stamp of one list and a stamp of the other; infinity if either is
// empty.
double SmallestGap(std::span<const double> depth_stamps_s, std::span<const double> colour_stamps_s);

}  // namespace tessera
