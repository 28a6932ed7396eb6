// Predicted views of the map by ray casting: empty space is left out block by block, the band is
// crossed in steps of the stored distance, the zero crossing found by trilinear interpolation.
#pragma once

#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/cpu.h"
#include "mapping/block_map.h"
#include "mapping/predicted_view.h"
#include "mapping/ray_ranges.h"

namespace tessera {

struct RayArguments;

// Rays must not be walked beyond this depth, where the picture's corners leave the vector code's
// reach (kRayReachBlocks).
float FarthestRayDepth(const BlockMap::Config& map, const PinholeCamera& camera);

// What the kernels need of a view taken from there; the map's layers and the images are the
// caller's to enter.
RayArguments MakeRayArguments(const BlockMap::Config& map, const PinholeCamera& camera,
                              const Eigen::Isometry3d& T_world_camera);

// What the kernels need to fill `view`, whose size, camera and pose are set, from the map. Points
// into both.
RayArguments RayArgumentsFor(const BlockMap& map, PredictedView& view);

// Works on all of TBB's threads and gives the same bytes for any number of them. Surface is where
// all eight voxels around a point are known and the distance falls through zero; a fall over the
// whole range at once is an occlusion's edge and passed through, as by the mesher.
class RayCaster : public ViewPredictor {
  public:
    explicit RayCaster(VectorPath path = VectorPath::kAuto);

    void Predict(const BlockMap& map, const PinholeCamera& camera,
                 const Eigen::Isometry3d& T_world_camera, float min_depth_m, float max_depth_m,
                 PredictedView& view) override;

  private:
    void CastRow(const RayArguments& arguments, int y) const;

    bool use_avx2_;
    RayRanges ranges_;
};

}  // namespace tessera
