// Which pixels of a frame show something that moves, and where the map's surface has gone: what is
// left out of tracking and fusion, and what fusion forgets sooner.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/frame.h"
#include "core/image.h"

namespace tessera {

// In tiles of `step` x `step` pixels: tile (k, l) covers the pixels from (k step, l step) on, the
// last ones also what is left of a row or column.
struct MovingMask {
    int step = 1;
    Image<std::uint8_t> moving;  // 1: moves; to be neither tracked on nor fused
    // The map's surface before this depth is gone; 0: none is known to be.
    DepthImage gone_m;
    std::int64_t moving_tiles = 0, gone_tiles = 0;

    int TileX(int x) const { return std::min(x / step, moving.width() - 1); }
    int TileY(int y) const { return std::min(y / step, moving.height() - 1); }
    // Share of the image.
    double moving_fraction() const {
        return static_cast<double>(moving_tiles) / static_cast<double>(moving.size());
    }
};

// What a detector says may move in a frame: the depth, as the camera gave it, of the pixels that
// show it, 0 elsewhere.
struct MovingHint {
    DepthImage depth_m;
    double stamp_s = 0;  // the frame's
};

// No depth where something moves, in row y of a depth image of the masked frame's size.
void HideMoving(const MovingMask& mask, int y, int width, float* depth_m);
// The frame without the depth of what moves.
Frame WithoutMoving(const MovingMask& mask, const Frame& frame);
// What moves in magenta, for a person to look at. `colour` is the frame's at 1/`shrunk` of its
// size.
void TintMoving(const MovingMask& mask, int shrunk, ColourImage& colour);

}  // namespace tessera
