// Which views of a recording show what camera took them.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "optimize/camera_pair.h"

namespace tessera {

// Pairs with most turn, which shows the focal length, and least parallax, which does not; each view
// in a few pairs only. They have T_to_from by the given poses. `camera`: full resolution.
std::vector<CameraPair> ChoosePairs(const std::vector<CameraView>& views,
                                    const PinholeCamera& camera,
                                    const std::vector<Eigen::Isometry3d>& T_world_camera);

}  // namespace tessera
