// The painted room, as a depth camera with errors sees it.
#pragma once

#include <cmath>

#include "optimize/painted_room.h"

namespace tessera::painted_room {

// Error of the inverse depth, 1/m: a bump in the middle and waves. It has no tilt across the image,
// of which this room shows little: a tilt leaves planes plane.
inline double ErrorAt(double u, double v) {
    const double x = (u - 159.5) / 160, y = (v - 119.5) / 120;
    return 0.008 * (std::exp(-4 * (x * x + y * y)) - 0.2) + 0.003 * std::sin(5 * x + 3 * y);
}

inline Frame DistortedView(int number) {
    Frame frame = View(number, 0);
    for (int v = 0; v < kCamera.height; ++v)
        for (int u = 0; u < kCamera.width; ++u) {
            float& z = frame.depth_m(u, v);
            z = static_cast<float>(1 / (1 / z + ErrorAt(u, v)));
        }
    return frame;
}

}  // namespace tessera::painted_room
