// Where the SDF tracker's sums over points are taken, if not by the processor: on a device that
// keeps the map.
#pragma once

#include "mapping/block_map.h"
#include "tracking/frame_points.h"
#include "tracking/pose_solver.h"
#include "tracking/residual_sums.h"
#include "tracking/sdf_rows.h"

namespace tessera {

// Owner thread only.
class SdfSums {
  public:
    virtual ~SdfSums() = default;

    // The points that the next calls of Sum go over, in this map: those of MakePointArguments'
    // `points` of this frame, in FramePoints' slots and with its bytes. How many have a weight; 0
    // also where there is no room for them.
    virtual std::int64_t SetPoints(const BlockMap& map, const PreparedFrame& frame,
                                   const PointArguments& points) = 0;
    // What SumSdfPoints gives over all of them. Of the arguments the map's and the points' arrays
    // are not read.
    virtual PoseSums Sum(const SdfArguments& arguments) = 0;
    // What SumResiduals gives of those points, their residuals at the last Sum, whose arguments
    // asked for them, and the frame. Of the arguments no arrays are read.
    virtual ResidualSums SumResiduals(const ResidualArguments& arguments) = 0;
};

}  // namespace tessera
