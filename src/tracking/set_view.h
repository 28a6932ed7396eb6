// Fills ViewArguments from a camera and a pose.
#pragma once

#include <Eigen/Geometry>

#include "core/camera.h"
#include "tracking/view_arguments.h"

namespace tessera {

inline void SetCamera(const PinholeCamera& camera, ViewArguments& a) {
    a.width = camera.width;
    a.height = camera.height;
    a.fx = static_cast<float>(camera.fx);
    a.fy = static_cast<float>(camera.fy);
    a.cx = static_cast<float>(camera.cx);
    a.cy = static_cast<float>(camera.cy);
}

inline void SetPose(const Eigen::Isometry3d& T_view_point, ViewArguments& a) {
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            a.rotation[3 * i + j] = static_cast<float>(T_view_point.linear()(i, j));
        a.translation[i] = static_cast<float>(T_view_point.translation()(i));
    }
}

}  // namespace tessera
