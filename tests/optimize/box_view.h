// A box in front of a wall, both of even colours, seen without noise from many places. Colour is
// moved by a known number of pixels.
#pragma once

#include "core/frame.h"

namespace tessera {

inline constexpr int kBoxViewWidth = 640, kBoxViewHeight = 480;

// `shadow_px`: columns without depth left of the box, as beside a structured-light projector's.
inline Frame BoxView(int number, int shift_x, int shift_y, int shadow_px = 0) {
    Frame frame;
    frame.depth_m = DepthImage(kBoxViewWidth, kBoxViewHeight, 3.0f);
    frame.colour = ColourImage(kBoxViewWidth, kBoxViewHeight, {90, 120, 80});
    const int left = 180 + 7 * number, top = 120 + 5 * (number % 9), side = 150 + number;
    for (int v = top; v < top + side; ++v) {
        for (int u = left - shadow_px; u < left; ++u) frame.depth_m(u, v) = 0;
        for (int u = left; u < left + side; ++u) {
            frame.depth_m(u, v) = 1.5f;
            frame.colour(u + shift_x, v + shift_y) = {200, 60, 40};
        }
    }
    return frame;
}

}  // namespace tessera
