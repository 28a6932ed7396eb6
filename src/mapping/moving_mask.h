// Which pixels of a frame show moving objects, and which map surfaces have disappeared. Tracking
// and fusion skip moving pixels. Fusion forgets disappeared surfaces faster.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/frame.h"
#include "core/image.h"

namespace tessera {

// In tiles of `step` x `step` pixels: tile (k, l) starts at pixel (k step, l step). The last tile
// of a row or column also covers the remaining pixels.
struct MovingMask {
    int step = 1;
    Image<std::uint8_t> moving;  // 1 = moving: neither tracked nor fused
    // Map surfaces nearer than this depth have disappeared; 0 = none known.
    DepthImage gone_m;
    std::int64_t moving_tiles = 0, gone_tiles = 0;

    int TileX(int x) const { return std::min(x / step, moving.width() - 1); }
    int TileY(int y) const { return std::min(y / step, moving.height() - 1); }
    // Fraction of the image that moves.
    double moving_fraction() const {
        return static_cast<double>(moving_tiles) / static_cast<double>(moving.size());
    }
};

// Pixels of a frame that may move according to a detector: their depth as measured by the camera, 0
// elsewhere.
struct MovingHint {
    DepthImage depth_m;
    double stamp_s = 0;  // timestamp of the frame
};

// Removes the depth of moving pixels from row y of a depth image of the masked frame's size.
void HideMoving(const MovingMask& mask, int y, int width, float* depth_m);
// Returns the frame without the depth of moving pixels.
Frame WithoutMoving(const MovingMask& mask, const Frame& frame);
// Tints moving pixels magenta for display. `colour` is the frame's image at 1/`shrunk` of its size.
void TintMoving(const MovingMask& mask, int shrunk, ColourImage& colour);

}  // namespace tessera
