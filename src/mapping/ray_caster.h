// Predicted views of the map by ray casting: empty space is left out block by block, the band is
// crossed in steps of the stored distance, the zero crossing found by trilinear interpolation.
#pragma once

#include <Eigen/Geometry>

#include "core/camera.h"
#include "mapping/block_map.h"
#include "mapping/predicted_view.h"
#include "mapping/ray_ranges.h"

namespace tessera {

// Owner thread only; Cast works on all of TBB's threads and gives the same bytes for any number of
// them. Nobody may write the map meanwhile.
class RayCaster {
  public:
    // The first surface seen from the front on each pixel's ray, between the two depths (metres
    // along z, min > 0). Surface is where all eight voxels around a point are known and the
    // distance falls through zero; a fall over the whole range at once is an occlusion's edge and
    // passed through, as by the mesher.
    PredictedView Cast(const BlockMap& map, const PinholeCamera& camera,
                       const Eigen::Isometry3d& T_world_camera, float min_depth_m,
                       float max_depth_m);
    // The same into a view whose storage is used again.
    void Cast(const BlockMap& map, const PinholeCamera& camera,
              const Eigen::Isometry3d& T_world_camera, float min_depth_m, float max_depth_m,
              PredictedView& view);

  private:
    RayRanges ranges_;
};

}  // namespace tessera
