// Selects the pairs of views that best constrain the camera.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "optimize/camera_pair.h"

namespace tessera {

// Prefers pairs with much rotation, which constrains the focal length, and little parallax, which
// does not. Uses each view in only a few pairs. Sets T_to_from from the given poses. `camera`: full
// resolution.
std::vector<CameraPair> ChoosePairs(const std::vector<CameraView>& views,
                                    const PinholeCamera& camera,
                                    const std::vector<Eigen::Isometry3d>& T_world_camera);

}  // namespace tessera
