// Where the ICP tracker's view is predicted and its sums over points are taken, if not by the
// processor: on a device that keeps the map.
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

    // The model that the next points are held against: as many levels as BuildIcpModel makes of
    // what RayCaster predicts. The view is valid until somebody has another one predicted on the
    // same device.
    virtual void Predict(const BlockMap& map, const PinholeCamera& camera,
                         const Eigen::Isometry3d& T_world_camera, float min_depth_m,
                         float max_depth_m, int levels, float jump_m) = 0;
    // The same where the processor predicted it.
    virtual void SetModel(const std::vector<IcpModelLevel>& levels) = 0;
    // The points that the next calls of Sum go over, and the level of the model that belongs to
    // them: those of MakePointArguments' `points` of this frame with normals, in FramePoints' slots
    // and with its bytes. How many have a weight; 0 also where there is no room. Nothing is kept
    // yet.
    virtual std::int64_t SetPoints(const PreparedFrame& frame, const PointArguments& points,
                                   int level) = 0;
    // What SumIcpPoints gives over all of them. Of the arguments no arrays are read; the energies
    // are compared with the kept residuals where distance_before is not null.
    virtual PoseSums Sum(const IcpArguments& arguments) = 0;
    // The last Sum's residuals are those to compare with from here on.
    virtual void KeepResiduals() = 0;
    // What SumResiduals gives of the points, the kept residuals and the frame. Of the arguments no
    // arrays are read.
    virtual ResidualSums SumResiduals(const ResidualArguments& arguments) = 0;
};

}  // namespace tessera
