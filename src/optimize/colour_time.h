// Where a surface is in the colour image of a moving camera. Colour and depth have their own time
// stamps, and a rolling shutter reads the rows one after another (FrameMotion).
#pragma once

#include "core/camera.h"
#include "core/frame_motion.h"

namespace tessera {

// The pixel of the colour image that shows what `pixel` of the depth image measured at z, metres;
// 0: unknown, taken as far away. To first order in time; the row's time is that of `pixel`.
inline Eigen::Vector2d ColourPixel(const PinholeCamera& camera, const FrameMotion& motion,
                                   const Eigen::Vector2d& pixel, double z) {
    const double time_s =
        motion.ColourTime(pixel.y(), camera.height) - motion.DepthTime(pixel.y(), camera.height);
    const Eigen::Vector3d p = camera.Unproject(pixel.x(), pixel.y(), z > 0 ? z : 1.0);
    Eigen::Vector3d velocity = motion.twist_per_s.head<3>().cross(p);
    if (z > 0) velocity += motion.twist_per_s.tail<3>();
    const Eigen::Vector3d moved = p - time_s * velocity;
    return moved.z() > 0 ? camera.Project(moved) : pixel;
}

}  // namespace tessera
