// Fits one depth distortion, and the motion of each pair, to pairs of views that show the same
// surfaces in different places of the image.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/camera.h"
#include "core/depth_distortion.h"
#include "optimize/depth_view.h"

namespace tessera {

struct DepthPair {
    int from = 0, to = 0;  // indices of views
    Eigen::Isometry3d T_to_from = Eigen::Isometry3d::Identity();
    bool usable = true;
};

struct DepthDistortionFit {
    DepthDistortion distortion;  // of mean 0: a common offset is not estimated
    // Root mean square over the nodes, and that of the nodes' standard deviations. These come from
    // how the gradients of parts differ: eighths of the recording, near and far.
    double rms_per_m = 0, sigma_per_m = 0;
    double noise_per_m = 0;  // standard deviation of a measured inverse depth
    int pairs = 0;           // that were used; 0: no result
};

// `pairs` in the order of time; their motions are refined.
DepthDistortionFit FitDepthDistortion(const std::vector<DepthView>& views,
                                      const PinholeCamera& camera, std::vector<DepthPair>& pairs);

}  // namespace tessera
