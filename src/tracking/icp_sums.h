// Interface for predicting the ICP tracker's view and taking its sums outside the CPU, on a device
// that holds the map.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "mapping/block_map.h"
#include "tracking/frame_points.h"
#include "tracking/icp_arguments.h"
#include "tracking/icp_model.h"
#include "tracking/pose_solver.h"
#include "tracking/residual_sums.h"

namespace tessera {

// Owner thread only.
class IcpSums {
  public:
    virtual ~IcpSums() = default;

    // Predicts the model for the next points: as many levels as BuildIcpModel makes of the view
    // that RayCaster predicts. The view is valid until another one is predicted on the same device.
    virtual void Predict(const BlockMap& map, const PinholeCamera& camera,
                         const Eigen::Isometry3d& T_world_camera, float min_depth_m,
                         float max_depth_m, int levels, float jump_m) = 0;
    // The same for a model that the CPU predicted.
    virtual void SetModel(const std::vector<IcpModelLevel>& levels) = 0;
    // Sets the points for the next calls of Sum, and their level of the model: the points of
    // MakePointArguments for this frame, with normals, in the slots of FramePoints and with its
    // bytes. Returns how many have a weight; 0 also if there is no room. No residuals are kept yet.
    virtual std::int64_t SetPoints(const PreparedFrame& frame, const PointArguments& points,
                                   int level) = 0;
    // Gives the sums of SumIcpPoints over all points. Reads no arrays of `arguments`. Compares
    // energies with the kept residuals if distance_before is not null.
    virtual PoseSums Sum(const IcpArguments& arguments) = 0;
    // Keeps the last Sum's residuals for comparison from here on.
    virtual void KeepResiduals() = 0;
    // Gives the result of SumResiduals for the points, the kept residuals and the frame. Reads no
    // arrays of `arguments`.
    virtual ResidualSums SumResiduals(const ResidualArguments& arguments) = 0;
};

}  // namespace tessera
