// Predicts views of the map by ray casting: skips empty space block by block, crosses the band in
// steps of the stored distance, and finds the zero crossing by trilinear interpolation.
#pragma once

#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/cpu.h"
#include "mapping/block_map.h"
#include "mapping/predicted_view.h"
#include "mapping/ray_ranges.h"

namespace tessera {

struct RayArguments;

// Rays must not be walked beyond this depth: there the image corners leave the reach of the SIMD
// kernels (kRayReachBlocks).
float FarthestRayDepth(const BlockMap::Config& map, const PinholeCamera& camera);

// Kernel arguments for a view from this pose. The caller fills in the map's layers and the images.
RayArguments MakeRayArguments(const BlockMap::Config& map, const PinholeCamera& camera,
                              const Eigen::Isometry3d& T_world_camera);

// Kernel arguments that fill `view` from the map. The size, camera and pose of `view` must be set.
// The result points into both.
RayArguments RayArgumentsFor(const BlockMap& map, PredictedView& view);

// Runs on all TBB threads and gives the same bytes for any number of them. A surface point is where
// all eight surrounding voxels are known and the distance falls through zero. A drop over the whole
// range at once is an occlusion edge; rays pass through it, as in the mesher.
class RayCaster : public ViewPredictor {
  public:
    explicit RayCaster(VectorPath path = VectorPath::kAuto);

    void Predict(const BlockMap& map, const PinholeCamera& camera,
                 const Eigen::Isometry3d& T_world_camera, float min_depth_m, float max_depth_m,
                 PredictedView& view) override;

  private:
    void CastRow(const RayArguments& arguments, int y) const;

    VectorPath path_;
    RayRanges ranges_;
};

}  // namespace tessera
