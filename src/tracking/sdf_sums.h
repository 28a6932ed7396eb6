// Interface for taking the SDF tracker's sums outside the CPU, on a device that holds the map.
#pragma once

#include "mapping/block_map.h"
#include "tracking/frame_points.h"
#include "tracking/pose_solver.h"
#include "tracking/residual_sums.h"
#include "tracking/sdf_simd.h"

namespace tessera {

// Owner thread only.
class SdfSums {
  public:
    virtual ~SdfSums() = default;

    // Sets the points for the next calls of Sum, in this map: the points of MakePointArguments for
    // this frame, in the slots of FramePoints and with its bytes. Returns how many have a weight; 0
    // also if there is no room.
    virtual std::int64_t SetPoints(const BlockMap& map, const PreparedFrame& frame,
                                   const PointArguments& points) = 0;
    // Gives the sums of SumSdfPoints over all points. Does not read the arrays of the map and of
    // the points in `arguments`.
    virtual PoseSums Sum(const SdfArguments& arguments) = 0;
    // Gives the result of SumResiduals for these points, their residuals at the last Sum, and the
    // frame. The arguments of that Sum must have requested residuals. Reads no arrays of
    // `arguments`.
    virtual ResidualSums SumResiduals(const ResidualArguments& arguments) = 0;
};

}  // namespace tessera
