// The predicted view as a pyramid for the ICP tracker; each level has half the size of the last.
#pragma once

#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "mapping/predicted_view.h"
#include "tracking/icp_arguments.h"

namespace tessera {

struct IcpModelLevel {
    PinholeCamera camera;
    DepthImage depth_m;  // 0 where there is no surface
    Image<Eigen::Vector3f> normal_camera;
    Image<float> intensity;  // -1 where there is none, and beside depth discontinuities
};

// The camera of an image of half the size. Its pixel i lies between pixels 2 i and 2 i + 1 of the
// fine image.
PinholeCamera HalfOf(const PinholeCamera& fine);

// Level 0 is the view. Each further level holds means of two by two pixels that belong to one
// surface; pixels whose depths differ by more than jump_m do not. Reuses the storage of `levels`.
void BuildIcpModel(const PredictedView& view, int count, float jump_m,
                   std::vector<IcpModelLevel>& levels);

// Enters a level into the arguments. Its images are empty if a device has them.
void SetModel(const IcpModelLevel& model, IcpArguments& arguments);

}  // namespace tessera
