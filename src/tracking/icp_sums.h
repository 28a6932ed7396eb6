// The ICP tracker's predicted model and its work over all points, on the CPU or on a device that
// holds the map.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/cpu.h"
#include "mapping/block_map.h"
#include "mapping/ray_caster.h"
#include "tracking/frame_points.h"
#include "tracking/icp_arguments.h"
#include "tracking/icp_model.h"
#include "tracking/pose_solver.h"
#include "tracking/residual_sums.h"

namespace tessera {

// Depth limits of a predicted view, in metres along z, and the depth step that ends a surface.
struct ModelRange {
    float near_m = 0, far_m = 0, jump_m = 0;
};

// Owner thread only.
class IcpSums {
  public:
    virtual ~IcpSums() = default;

    // Casts the view from this pose and makes as many levels of a model of it (BuildIcpModel). A
    // device keeps the images, until another view is predicted on it; `view` and `model` then
    // contain cameras and the pose only.
    virtual void Predict(const BlockMap& map, const PinholeCamera& camera,
                         const Eigen::Isometry3d& T_world_camera, const ModelRange& range,
                         int levels, PredictedView& view, std::vector<IcpModelLevel>& model) = 0;
    // Takes a model that was predicted in another way.
    virtual void SetModel(const std::vector<IcpModelLevel>& levels) = 0;
    // Makes the frame's points for the next calls of Sum, against this level of the model, and lays
    // out their slots. A device keeps the points and leaves the slots' contents unspecified;
    // without room for them, no point is valid. No residuals are kept yet.
    virtual void SetPoints(const PreparedFrame& frame, const PointArguments& arguments, int level,
                           FramePoints& slots) = 0;
    // The sums of SumIcpPoints over all `points` slots. Compares energies with the kept residuals
    // if distance_before is not null. A device reads no arrays of `arguments`.
    virtual PoseSums Sum(const IcpArguments& arguments, int points) = 0;
    // Keeps the residuals of the last Sum, `last`, for comparison from here on.
    virtual void KeepResiduals(PointResiduals& kept, PointResiduals& last) = 0;
    // SumResiduals for the points, the kept residuals and the frame. A device reads no arrays of
    // `arguments`.
    virtual ResidualSums SumResiduals(const ResidualArguments& arguments) = 0;
    // RemoveShading for the points and the kept residuals. A device reads no arrays of `arguments`.
    virtual void RemoveShading(const ShadingArguments& arguments) = 0;
};

class CpuIcpSums : public IcpSums {
  public:
    explicit CpuIcpSums(VectorPath path = VectorPath::kAuto) : path_(path), caster_(path) {}

    void Predict(const BlockMap& map, const PinholeCamera& camera,
                 const Eigen::Isometry3d& T_world_camera, const ModelRange& range, int levels,
                 PredictedView& view, std::vector<IcpModelLevel>& model) override;
    void SetModel(const std::vector<IcpModelLevel>&) override {}
    void SetPoints(const PreparedFrame& frame, const PointArguments& arguments, int level,
                   FramePoints& slots) override;
    PoseSums Sum(const IcpArguments& arguments, int points) override;
    void KeepResiduals(PointResiduals& kept, PointResiduals& last) override;
    ResidualSums SumResiduals(const ResidualArguments& arguments) override;
    void RemoveShading(const ShadingArguments& arguments) override;

  private:
    VectorPath path_;
    RayCaster caster_;
};

}  // namespace tessera
