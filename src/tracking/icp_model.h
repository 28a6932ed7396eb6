// The predicted view as the ICP tracker aligns with it: levels of half the size each.
#pragma once

#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "mapping/predicted_view.h"
#include "tracking/icp_arguments.h"

namespace tessera {

struct IcpModelLevel {
    PinholeCamera camera;
    DepthImage depth_m;  // 0 where nothing is
    Image<Eigen::Vector3f> normal_camera;
    Image<float> intensity;  // -1 where there is none, and beside jumps of the depth
};

// The camera of an image of half the size: its pixel i lies between the pixels 2 i and 2 i + 1 of
// the fine one.
PinholeCamera HalfOf(const PinholeCamera& fine);

// Level 0 is the view; each further one holds means of two by two pixels where these are one
// surface. Neighbours whose depths differ by more than jump_m are not. Storage in `levels` is used
// again.
void BuildIcpModel(const PredictedView& view, int count, float jump_m,
                   std::vector<IcpModelLevel>& levels);

// As the sums take it; its images are empty where a device has them.
void SetModel(const IcpModelLevel& model, IcpArguments& arguments);

}  // namespace tessera
