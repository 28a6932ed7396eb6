// Chooses the image size and frame rate to request from a device. Plain values, so it is testable
// without the library.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace tessera {

struct StreamMode {
    int width = 0, height = 0, fps = 0;
    bool usable = true;  // its pixel format is supported (16-bit depth; RGB or grey colour)
    int preference = 0;  // tie-breaker; lower is better
};

// Returns the indices (depth, colour) of two usable modes with the same image size. Prefers the
// size nearest to 640 x 480, then the rates nearest to 30 per second, then the preferred pixel
// format. nullopt if no usable modes share a size.
std::optional<std::pair<std::size_t, std::size_t>> ChooseModes(
    const std::vector<StreamMode>& depth, const std::vector<StreamMode>& colour);

}  // namespace tessera
