// Which size and rate to ask a device for. Plain values: testable without the library.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace tessera {

struct StreamMode {
    int width = 0, height = 0, fps = 0;
    bool usable = true;  // its pixels can be read (16-bit depth; RGB or grey colour)
    int preference = 0;  // among equals, less is better
};

// The modes' indices (depth's, colour's) of the common size nearest to 640 x 480, then of the rates
// nearest to 30 per second, then the preferred pixels; nothing if no usable modes have the same
// size.
std::optional<std::pair<std::size_t, std::size_t>> ChooseModes(
    const std::vector<StreamMode>& depth, const std::vector<StreamMode>& colour);

}  // namespace tessera
