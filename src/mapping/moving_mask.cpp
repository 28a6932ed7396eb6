#include "mapping/moving_mask.h"

namespace tessera {

void HideMoving(const MovingMask& mask, DepthImage& depth_m) {
    for (int y = 0; y < depth_m.height(); ++y) {
        const std::uint8_t* moving = mask.moving.row(mask.TileY(y));
        float* depth = depth_m.row(y);
        for (int x = 0; x < depth_m.width(); ++x)
            if (moving[mask.TileX(x)] != 0) depth[x] = 0;
    }
}

Frame WithoutMoving(const MovingMask& mask, const Frame& frame) {
    Frame rest = frame;
    HideMoving(mask, rest.depth_m);
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
