// What a camera at a given pose would see of the map, and the interface that predicts it. The ray
// caster and the mesh rasteriser implement it; trackers do not know which one they use.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>

#include "core/camera.h"
#include "core/image.h"
#include "mapping/block_map.h"

namespace tessera {

// Images have the camera's size. Where depth_m is 0, there is no surface and the others are 0 too.
struct PredictedView {
    PinholeCamera camera;
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    DepthImage depth_m;  // along z
    Image<Eigen::Vector3f>
        normal_camera;       // unit, camera frame, out of the surface (towards the viewer)
    ColourImage colour;      // mid grey where the surface has no colour
    Image<float> intensity;  // [0, 1]; -1 where the surface has none

    // Prepares for a new view. Pixel values are unspecified afterwards.
    void Resize(const PinholeCamera& new_camera, const Eigen::Isometry3d& new_T_world_camera) {
        camera = new_camera;
        T_world_camera = new_T_world_camera;
        depth_m.Resize(camera.width, camera.height);
        normal_camera.Resize(camera.width, camera.height);
        colour.Resize(camera.width, camera.height);
        intensity.Resize(camera.width, camera.height);
    }
    // Sets all pixels to no surface.
    void SetNothing() {
        std::fill_n(depth_m.data(), depth_m.size(), 0.0f);
        std::fill_n(normal_camera.data(), normal_camera.size(), Eigen::Vector3f(0, 0, 0));
        std::fill_n(colour.data(), colour.size(), Rgb8{});
        std::fill_n(intensity.data(), intensity.size(), 0.0f);
    }
};

// Owner thread only.
class ViewPredictor {
  public:
    virtual ~ViewPredictor() = default;
    // Fills `view` with the first front-facing surface of each pixel between the two depths (metres
    // along z, min > 0). Reuses the storage of `view`. Nobody may write the map meanwhile.
    virtual void Predict(const BlockMap& map, const PinholeCamera& camera,
                         const Eigen::Isometry3d& T_world_camera, float min_depth_m,
                         float max_depth_m, PredictedView& view) = 0;
};

}  // namespace tessera
