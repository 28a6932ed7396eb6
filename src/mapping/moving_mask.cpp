#include "mapping/moving_mask.h"

namespace tessera {

void HideMoving(const MovingMask& mask, int y, int width, float* depth_m) {
    const std::uint8_t* moving = mask.moving.row(mask.TileY(y));
    const int tiles = mask.moving.width();
    for (int k = 0; k < tiles; ++k)
        if (moving[k] != 0)
            std::fill(depth_m + k * mask.step,
                      depth_m + (k + 1 < tiles ? (k + 1) * mask.step : width), 0.0f);
}

Frame WithoutMoving(const MovingMask& mask, const Frame& frame) {
    Frame rest = frame;
    for (int y = 0; y < rest.depth_m.height(); ++y)
        HideMoving(mask, y, rest.depth_m.width(), rest.depth_m.row(y));
    return rest;
}

void TintMoving(const MovingMask& mask, int shrunk, ColourImage& colour) {
    const auto half = [](int a, int b) { return static_cast<std::uint8_t>((a + b) / 2); };
    for (int y = 0; y < colour.height(); ++y)
        for (int x = 0; x < colour.width(); ++x) {
            if (mask.moving(mask.TileX(x * shrunk), mask.TileY(y * shrunk)) == 0) continue;
            Rgb8& c = colour(x, y);
            c = {half(c.r, 255), half(c.g, 0), half(c.b, 255)};
        }
}

}  // namespace tessera
