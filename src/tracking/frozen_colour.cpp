#include "tracking/frozen_colour.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>
#include <type_traits>

namespace tessera {
namespace {

// Of every eighth row: noise is everywhere.
template <class Pixel>
std::size_t HashOf(const Image<Pixel>& image) {
    static_assert(std::is_trivially_copyable_v<Pixel>);
    std::size_t hash = 0;
    for (int y = 0; y < image.height(); y += 8)
        hash = 31 * hash + std::hash<std::string_view>{}(std::string_view(
                               reinterpret_cast<const char*>(image.row(y)),
                               static_cast<std::size_t>(image.width()) * sizeof(Pixel)));
    return hash;
}

}  // namespace

bool FrozenColour::Repeats(const Frame& frame) {
    constexpr double kHangs_s = 0.5;
    repeats_ = hangs_ = false;
    if (frame.colour.empty()) return false;
    const std::size_t colour = HashOf(frame.colour), depth = HashOf(frame.depth_m);
    const auto* const first = frame.colour.data();
    repeats_ = colour == colour_ && depth != depth_ &&
               std::any_of(first, first + frame.colour.size(),
                           [&](const Rgb8& pixel) { return pixel != *first; });
    colour_ = colour;
    depth_ = depth;
    if (!repeats_) new_s_ = frame.stamp_s;
    hangs_ = repeats_ && std::abs(frame.stamp_s - new_s_) >= kHangs_s;
    return repeats_;
}

}  // namespace tessera
