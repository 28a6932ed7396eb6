// The sums of residual_kernels.h over a frame's finest points.
#pragma once

#include <vector>

#include "core/camera.h"
#include "mapping/prepared_frame.h"
#include "tracking/frame_points.h"
#include "tracking/residual_kernels.h"

namespace tessera {

// One group after another; empty where not asked for.
struct ResidualSums {
    std::vector<double> distances, scores, shutter;
};

// Of these points and their residuals. Nothing is asked for yet. The arrays stay the caller's.
ResidualArguments MakeResidualArguments(const PreparedFrame& frame, const PinholeCamera& camera, const FramePoints& points,
                                        const std::vector<float>& distance_residual,
                                        const std::vector<float>& intensity_residual);

// On all threads, the same bytes for any number of them.
ResidualSums SumResiduals(const ResidualArguments& arguments);

}  // namespace tessera
