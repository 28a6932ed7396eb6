// What a camera at a given pose would see of the map: the tracker's model view, and the preview.
// The ray caster fills it, and so can a rasteriser of the mesh.
#pragma once

#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/image.h"

namespace tessera {

// Images of the camera's size. Where depth_m is 0 there is no surface and the others are 0 too.
struct PredictedView {
    PinholeCamera camera;
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    DepthImage depth_m;  // along z
    Image<Eigen::Vector3f>
        normal_camera;       // unit, camera frame, out of the surface: towards the viewer
    ColourImage colour;      // mid grey where the surface has no colour
    Image<float> intensity;  // [0, 1]; -1 where the surface has none
};

}  // namespace tessera
