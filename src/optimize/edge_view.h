// Where near surfaces end in a frame's depth, and how strong the edges of its colour are: for
// estimates that compare the two.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/frame.h"

namespace tessera {

// The frame with about 320 columns, 479 at most.
struct EdgeView {
    // Right, left, down, up: opposite ones differ in the lowest bit of their index.
    static constexpr std::array<std::pair<int, int>, 4> kAhead = {
        {{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    static constexpr int kBorder = 21;  // pixels without ends at each side

    // A pixel where a near surface ends.
    struct End {
        std::int16_t x = 0, y = 0;
        float depth_m = 0;
    };

    int step_px = 1;  // one pixel of the view is the middle of so many of the frame, per axis
    std::array<std::vector<End>, kAhead.size()> ends;  // at most 1000 per direction
    // Strength of colour's edges across a column and across a row, from 0 to 1. 0 at the border.
    Image<float> across, down;

    const Image<float>& Strength(std::size_t direction) const {
        return kAhead[direction].first != 0 ? across : down;
    }
    bool empty() const { return across.empty(); }
};

// Empty without colour of depth's size. Thread-safe.
EdgeView MakeEdgeView(const Frame& frame);

}  // namespace tessera
