#include "io/stamp_pairing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "core/quantile.h"

namespace tessera {
namespace {

constexpr std::size_t kNoItem = std::numeric_limits<std::size_t>::max();

// Both lists merged by time, as a doubly linked list from which paired images are removed.
struct Item {
    double stamp_s;
    bool is_depth;
    std::size_t index;          // in its own list
    std::size_t before, after;  // in the merged list
    bool taken;
};

std::vector<Item> Merge(std::span<const double> depth, std::span<const double> colour) {
    std::vector<Item> items;
    items.reserve(depth.size() + colour.size());
    std::size_t d = 0, c = 0;
    while (d < depth.size() || c < colour.size()) {
        const bool is_depth = c == colour.size() || (d < depth.size() && depth[d] < colour[c]);
        const std::size_t index = is_depth ? d++ : c++;
        const std::size_t at = items.size();
        items.push_back({is_depth ? depth[index] : colour[index], is_depth, index,
                         at == 0 ? kNoItem : at - 1, at + 1, false});
    }
    if (!items.empty()) items.back().after = kNoItem;
    return items;
}

struct Candidate {
    double gap_s;
    double colour_stamp_s, depth_stamp_s;
    std::size_t first, second;  // in the merged list

    bool operator>(const Candidate& o) const {
        return std::tie(gap_s, colour_stamp_s, depth_stamp_s) >
               std::tie(o.gap_s, o.colour_stamp_s, o.depth_stamp_s);
    }
};

// Median time from image to image; 0 if there are fewer than two.
double MedianInterval(std::span<const double> stamps_s) {
    std::vector<double> intervals_s;
    for (std::size_t i = 1; i < stamps_s.size(); ++i)
        intervals_s.push_back(stamps_s[i] - stamps_s[i - 1]);
    return intervals_s.empty() ? 0 : Median(std::move(intervals_s));
}

}  // namespace

double PairGap(double max_gap_s, std::span<const double> depth_stamps_s,
               std::span<const double> colour_stamps_s) {
    if (max_gap_s > 0) return max_gap_s;
    constexpr double kLeast_s = 0.02, kMost_s = 0.05;
    const double slower_s =
        std::max(MedianInterval(depth_stamps_s), MedianInterval(colour_stamps_s));
    return std::clamp(slower_s / 2, kLeast_s, kMost_s);
}

// The closest remaining pair is always adjacent in the merged order: anything between the two would
// be closer to one of them. So only neighbours are candidates, and removing a pair creates one new
// candidate.
std::vector<StampPair> PairNearest(std::span<const double> depth_stamps_s,
                                   std::span<const double> colour_stamps_s, double max_gap_s,
                                   double colour_delay_s) {
    std::vector<double> colour_s(colour_stamps_s.begin(), colour_stamps_s.end());
    for (double& stamp_s : colour_s) stamp_s += colour_delay_s;
    max_gap_s += std::abs(colour_delay_s);
    std::vector<Item> items = Merge(depth_stamps_s, colour_s);
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> candidates;
    const auto consider = [&](std::size_t first, std::size_t second) {
        if (first == kNoItem || second == kNoItem ||
            items[first].is_depth == items[second].is_depth)
            return;
        const Item& depth = items[items[first].is_depth ? first : second];
        const Item& colour = items[items[first].is_depth ? second : first];
        const double gap_s = std::abs(colour.stamp_s - depth.stamp_s);
        if (gap_s < max_gap_s)
            candidates.push({gap_s, colour.stamp_s, depth.stamp_s, first, second});
    };
    for (std::size_t i = 0; i + 1 < items.size(); ++i) consider(i, i + 1);

    std::vector<StampPair> pairs;
    while (!candidates.empty()) {
        const Candidate best = candidates.top();
        candidates.pop();
        Item& first = items[best.first];
        Item& second = items[best.second];
        if (first.taken || second.taken) continue;
        first.taken = second.taken = true;
        pairs.push_back({first.is_depth ? first.index : second.index,
                         first.is_depth ? second.index : first.index});
        if (first.before != kNoItem) items[first.before].after = second.after;
        if (second.after != kNoItem) items[second.after].before = first.before;
        consider(first.before, second.after);
    }
    std::sort(pairs.begin(), pairs.end(),
              [](const StampPair& a, const StampPair& b) { return a.depth < b.depth; });
    return pairs;
}

double SmallestGap(std::span<const double> depth_stamps_s,
                   std::span<const double> colour_stamps_s) {
    const std::vector<Item> items = Merge(depth_stamps_s, colour_stamps_s);
    double smallest_s = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < items.size(); ++i)
        if (items[i].is_depth != items[i + 1].is_depth)
            smallest_s = std::min(smallest_s, items[i + 1].stamp_s - items[i].stamp_s);
    return smallest_s;
}

}  // namespace tessera
