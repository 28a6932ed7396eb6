// A reduced depth image for estimating a depth camera's errors: means of the inverse depth where
// the surface is smooth, and its normals.
#pragma once

#include <Eigen/Core>

#include "core/camera.h"
#include "core/image.h"

namespace tessera {

struct DepthView {
    int reduction = 1;  // one pixel here covers so many full-resolution pixels per axis
    // 1/m; 0 where depth is missing, at discontinuities, and where there is no normal.
    Image<float> inverse_depth;
    Image<Eigen::Vector3f> normal;  // of length 1, away from the camera
};

// About 160 columns. `camera`: that of the image.
DepthView MakeDepthView(const DepthImage& depth_m, const PinholeCamera& camera);

}  // namespace tessera
