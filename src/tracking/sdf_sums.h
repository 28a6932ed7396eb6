// The SDF tracker's work over all points, on the CPU or on a device that holds the map.
#pragma once

#include "core/cpu.h"
#include "mapping/block_map.h"
#include "tracking/frame_points.h"
#include "tracking/pose_solver.h"
#include "tracking/residual_sums.h"
#include "tracking/sdf_arguments.h"

namespace tessera {

// Owner thread only.
class SdfSums {
  public:
    virtual ~SdfSums() = default;

    // Makes the frame's points for the next calls of Sum, in this map, and lays out their slots. A
    // device keeps the points and leaves the slots' contents unspecified; without room for them, no
    // point is valid.
    virtual void SetPoints(const BlockMap& map, const PreparedFrame& frame,
                           const PointArguments& arguments, FramePoints& slots) = 0;
    // The sums of SumSdfPoints over all `points` slots. A device does not read the arrays of the
    // map and of the points in `arguments`.
    virtual PoseSums Sum(const SdfArguments& arguments, int points) = 0;
    // SumResiduals for these points, their residuals at the last Sum, and the frame. The arguments
    // of that Sum must have requested residuals. A device reads no arrays of `arguments`.
    virtual ResidualSums SumResiduals(const ResidualArguments& arguments) = 0;
    // RemoveShading for these points and their residuals at the last Sum, which must have requested
    // them. A device reads no arrays of `arguments`.
    virtual void RemoveShading(const ShadingArguments& arguments) = 0;
};

class CpuSdfSums : public SdfSums {
  public:
    explicit CpuSdfSums(VectorPath path = VectorPath::kAuto) : path_(path) {}

    void SetPoints(const BlockMap& map, const PreparedFrame& frame, const PointArguments& arguments,
                   FramePoints& slots) override;
    PoseSums Sum(const SdfArguments& arguments, int points) override;
    ResidualSums SumResiduals(const ResidualArguments& arguments) override;
    void RemoveShading(const ShadingArguments& arguments) override;

  private:
    VectorPath path_;
};

}  // namespace tessera
