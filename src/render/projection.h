// Projection from the camera frame to OpenGL clip space, and from the depth buffer back to metres:
// [D18] eq. 11-13 with the camera's own intrinsics instead of a field of view. Pure functions.
#pragma once

#include <Eigen/Core>

#include "core/camera.h"

namespace tessera {

// Transforms points of the camera frame (z forward, y down) to OpenGL clip space (z in [-w, w]).
// Image row 0 becomes window row 0, so that a read-back needs no flip. Front faces are therefore
// clockwise in the window. Pixel (u, v) lies at window position (u + 0.5, v + 0.5), where OpenGL
// samples it.
inline Eigen::Matrix4d ClipFromCamera(const PinholeCamera& camera, double near_m, double far_m) {
    const double width = camera.width, height = camera.height, range = far_m - near_m;
    Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
    m(0, 0) = 2 * camera.fx / width;
    m(0, 2) = 2 * (camera.cx + 0.5) / width - 1;
    m(1, 1) = 2 * camera.fy / height;
    m(1, 2) = 2 * (camera.cy + 0.5) / height - 1;
    m(2, 2) = (far_m + near_m) / range;
    m(2, 3) = -2 * far_m * near_m / range;
    m(3, 2) = 1;
    return m;
}

// [D18] eq. 11, whose last term must read 1/2 and not 1/Z: the depth buffer value, in [0, 1], of a
// point at depth z_m in [near_m, far_m].
inline double DepthBufferValue(double z_m, double near_m, double far_m) {
    return far_m / (far_m - near_m) * (1 - near_m / z_m);
}

// [D18] eq. 12, the inverse: depth along z in metres. `buffer` is in [0, 1].
inline double DepthFromBuffer(double buffer, double near_m, double far_m) {
    return far_m * near_m / (far_m - buffer * (far_m - near_m));
}

}  // namespace tessera
