// Which colour image belongs to which depth image.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tessera {

struct StampPair {
    std::size_t depth = 0, colour = 0;  // indices into the two lists
};

// As the TUM tools' associate.py: of all pairs less than max_gap_s apart the closest is taken, then
// the next closest of what remains, each image once; equal gaps in order of the colour, then of the
// depth stamp. Sorted by depth stamp. Both lists strictly increasing and finite. O(n log n),
// however close the stamps lie. Thread-safe.
std::vector<StampPair> PairNearest(std::span<const double> depth_stamps_s,
                                   std::span<const double> colour_stamps_s, double max_gap_s);

// The least distance between a stamp of either list and one of the other; infinity if one is empty.
double SmallestGap(std::span<const double> depth_stamps_s, std::span<const double> colour_stamps_s);

}  // namespace tessera
