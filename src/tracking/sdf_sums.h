// Where the SDF tracker's sums over points are taken, if not by the processor: on a device that keeps the map.
#pragma once

#include <vector>

#include "mapping/block_map.h"
#include "tracking/frame_points.h"
#include "tracking/pose_solver.h"
#include "tracking/sdf_rows.h"

namespace tessera {

// Owner thread only.
class SdfSums {
  public:
    virtual ~SdfSums() = default;

    // The points that the next calls of Sum go over, in this map.
    virtual void SetPoints(const BlockMap& map, const FramePoints& points) = 0;
    // What SumSdfPoints gives over all of them. Of the arguments the map's and the points' arrays are not read.
    virtual PoseSums Sum(const SdfArguments& arguments) = 0;
    // Residuals per point at the last Sum whose arguments asked for them, NaN where unknown; intensities only if it did for those.
    virtual void TakeResiduals(std::vector<float>& distance, std::vector<float>& intensity) = 0;
};

}  // namespace tessera
