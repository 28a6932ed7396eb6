// Fits one depth distortion, and the motion of each pair, to pairs of views that show the same
// surfaces in different places of the image.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
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

struct DepthDistortionEstimate {
    DepthDistortion found;  // of mean 0: a common offset is not estimated
    // Root mean square over the nodes, and that of the nodes' standard deviations. These come from
    // how the gradients of parts differ: eighths of the recording, near and far.
    double rms_per_m = 0, sigma_per_m = 0;
    double largest_per_m = 0;
    // Standard deviation of a measured inverse depth, averaged over a few pixels.
    double noise_per_m = 0;
    int pairs = 0;      // of compared views
    bool used = false;  // it was corrected

    // True if the recording shows more than such an estimate can be wrong, and more than noise.
    bool shown() const;
};

// "depth is up to 15 mm wrong at 1 m, depending on the place in the image (6.5 +- 0.3 mm rms)".
std::string DepthDistortionText(const DepthDistortionEstimate& estimate);

// `pairs` in the order of time. Nothing if too few of them show the same surfaces.
std::optional<DepthDistortionEstimate> FitDepthDistortion(const std::vector<DepthView>& views,
                                                          const PinholeCamera& camera,
                                                          std::vector<DepthPair> pairs);

}  // namespace tessera
