#include "io/stream_pairing.h"

#include <cmath>
#include <utility>

namespace tessera {
namespace {

constexpr std::size_t kMostWaiting = 8;  // per stream
// A partner may arrive this many periods later than its stamp.
constexpr double kLatePeriods = 2;

}  // namespace

template <class Pixels>
void StreamPairing::Stream<Pixels>::Add(double stamp_s, Pixels& image) {
    items.push_back({stamp_s, {}});
    std::swap(items.back().image, image);
    if (spare.empty()) return;
    std::swap(image, spare.back());
    spare.pop_back();
}

template <class Pixels>
void StreamPairing::Stream<Pixels>::Drop() {
    if (!items.front().image.empty()) spare.push_back(std::move(items.front().image));
    items.pop_front();
}

void StreamPairing::AddDepth(double stamp_s, Image<std::uint16_t>& image) {
    depth_.Add(stamp_s, image);
}

void StreamPairing::AddColour(double stamp_s, ColourImage& image) { colour_.Add(stamp_s, image); }

void StreamPairing::Clear() {
    while (!depth_.items.empty()) depth_.Drop();
    while (!colour_.items.empty()) colour_.Drop();
}

double StreamPairing::Gap(std::size_t depth, std::size_t colour) const {
    return std::abs(depth_.items[depth].stamp_s - colour_.items[colour].stamp_s);
}

std::ptrdiff_t StreamPairing::Partner() const {
    const auto& depth = depth_.items;
    const auto& colour = colour_.items;
    const double stamp_s = depth.front().stamp_s;
    // A colour image nearer to the next depth image is left to that one.
    const auto is_the_next_ones = [&](std::size_t c) {
        return depth.size() > 1 && Gap(1, c) < Gap(0, c);
    };
    std::ptrdiff_t best = kNone;
    for (std::size_t c = 0; c < colour.size(); ++c)
        if (Gap(0, c) < max_gap_s_ && !is_the_next_ones(c) &&
            (best < 0 || Gap(0, c) < Gap(0, static_cast<std::size_t>(best))))
            best = static_cast<std::ptrdiff_t>(c);
    if (ended_ || (best >= 0 && Gap(0, static_cast<std::size_t>(best)) < period_s_ / 2))
        return best;
    const bool colour_is_past =
        !colour.empty() && colour.back().stamp_s >= stamp_s + (best >= 0 ? 0 : max_gap_s_);
    const bool depth_is_past = depth.size() > 1;
    if (best >= 0) return colour_is_past && depth_is_past ? best : kUndecided;
    const bool too_late = depth.back().stamp_s >= stamp_s + max_gap_s_ + kLatePeriods * period_s_;
    return colour_is_past || too_late ? kNone : kUndecided;
}

bool StreamPairing::Next(Pair& pair) {
    while (!depth_.items.empty()) {
        std::ptrdiff_t partner = Partner();
        if (partner == kUndecided && depth_.items.size() <= kMostWaiting) break;
        if (partner < 0) {
            depth_.Drop();
            ++depth_alone_;
            continue;
        }
        for (; partner > 0; --partner, ++colour_alone_) colour_.Drop();
        pair.depth_stamp_s = depth_.items.front().stamp_s;
        pair.colour_stamp_s = colour_.items.front().stamp_s;
        std::swap(pair.depth, depth_.items.front().image);
        std::swap(pair.colour, colour_.items.front().image);
        depth_.Drop();
        colour_.Drop();
        ++pairs_;
        return true;
    }
    const auto is_left_over = [&] {
        if (colour_.items.empty()) return false;
        if (colour_.items.size() > kMostWaiting || (ended_ && depth_.items.empty())) return true;
        return !depth_.items.empty() &&
               colour_.items.front().stamp_s <= depth_.items.front().stamp_s - max_gap_s_;
    };
    for (; is_left_over(); ++colour_alone_) colour_.Drop();
    return false;
}

}  // namespace tessera
