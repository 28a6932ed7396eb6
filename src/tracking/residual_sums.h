// The residuals of a frame's finest points, and the sums of residual_kernels.h over them.
#pragma once

#include <array>
#include <vector>

#include "core/camera.h"
#include "mapping/prepared_frame.h"
#include "tracking/frame_points.h"
#include "tracking/residual_kernels.h"
#include "tracking/shading_kernels.h"

namespace tessera {

// One number per point; NaN where there is none. Gradients are those of the distances.
struct PointResiduals {
    std::vector<float> distance_m, intensity;
    std::array<std::vector<float>, 3> gradient;

    void Resize(int points);
};

// Groups in order; empty if not requested.
struct ResidualSums {
    std::vector<double> distances, scores, shutter;
};

// Arguments for these points and residuals. The caller fills in what depends on the pose, and which
// sums to compute. The arguments refer to the caller's arrays.
ResidualArguments MakeResidualArguments(const PreparedFrame& frame, const PinholeCamera& camera,
                                        const FramePoints& points, const PointResiduals& residuals);

// Runs on all threads; the same bytes for any number of them.
ResidualSums SumResiduals(const ResidualArguments& arguments);

// Arguments for these points and their residuals, without the patches' arrays. `limit`: the Huber
// scale of intensities.
ShadingArguments MakeShadingArguments(FramePoints& points, const PointResiduals& residuals,
                                      double gain, double limit);

// Adds the shading that the residuals show to the intensities of the points. The patches' arrays
// are its own. Runs on all threads; the same bytes for any number of them.
void RemoveShading(ShadingArguments arguments);

}  // namespace tessera
