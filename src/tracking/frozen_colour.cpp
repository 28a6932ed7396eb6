#include "tracking/frozen_colour.h"

#include <algorithm>
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
    if (frame.colour.empty()) return false;
    const std::size_t colour = HashOf(frame.colour), depth = HashOf(frame.depth_m);
    const bool repeats = colour == colour_ && depth != depth_;
    colour_ = colour;
    depth_ = depth;
    const auto* const first = frame.colour.data();
    return repeats && std::any_of(first, first + frame.colour.size(),
                                  [&](const Rgb8& pixel) { return pixel != *first; });
}

}  // namespace tessera
