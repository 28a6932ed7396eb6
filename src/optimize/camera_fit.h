// Fits one camera to many pairs of views. Gauss-Newton over all motions and the camera unknowns,
// coarse to fine; the motions are eliminated pair by pair.
#pragma once

#include <optional>
#include <vector>

#include "optimize/camera_estimate.h"
#include "optimize/camera_pair.h"

namespace tessera {

// `pairs` must have initial motions. `views` must be in time order. Nothing if too few pairs are
// usable to the end. The result does not depend on the number of threads.
//
// Standard deviations come from differences between parts: eight time spans, rings and quadrants of
// the image, near and far, vertical and horizontal edges; variances added. An error that the model
// lacks (lens distortion, a distorted depth image) differs between these parts. Motions are free in
// both misfits.
std::optional<CameraEstimate> FitCamera(const std::vector<CameraView>& views,
                                        const PinholeCamera& given, std::vector<CameraPair> pairs);

}  // namespace tessera
