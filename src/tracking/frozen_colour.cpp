#include "tracking/frozen_colour.h"

#include <algorithm>
#include <functional>
#include <string_view>
#include <type_traits>

namespace tessera {
namespace {

template <class Pixel>
std::size_t HashOf(const Image<Pixel>& image) {
    static_assert(std::is_trivially_copyable_v<Pixel>);
    const std::string_view bytes(reinterpret_cast<const char*>(image.data()),
                                 image.size() * sizeof(Pixel));
    return std::hash<std::string_view>{}(bytes);
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
