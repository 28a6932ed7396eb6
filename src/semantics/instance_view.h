// Predicts which instance each pixel of a camera sees: the predicted object detection image of
// [D18] 3.4 (figure 8), ray cast or rasterised.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "mapping/ray_caster.h"
#include "render/mesh_rasteriser.h"
#include "semantics/instances.h"
#include "semantics/label_config.h"

namespace tessera {

// The map's owner thread only.
class InstanceView {
  public:
    explicit InstanceView(LabelPrediction source) : source_(source) {}
    // Takes effect at the next Predict.
    void Select(LabelPrediction source);

    // Sets `shown`, of the camera's size, to the instance of the voxel next to each pixel's
    // surface, as voted; 0: none, or no surface between the two depths (metres along z). The map
    // must have labels.
    void Predict(const BlockMap& map, const PinholeCamera& camera,
                 const Eigen::Isometry3d& T_world_camera, float min_depth_m, float max_depth_m,
                 Image<InstanceId>& shown);
    // Call when voxels of these blocks got votes.
    void Voted(std::span<const BlockId> blocks);

    // Why rays are cast although the rasteriser was selected; else empty.
    const std::string& warning() const { return warning_; }

  private:
    bool Rasterise(const BlockMap& map, const PinholeCamera& camera,
                   const Eigen::Isometry3d& T_world_camera, float min_depth_m, float max_depth_m,
                   Image<InstanceId>& shown);
    void GiveUp(const Status& status);

    LabelPrediction source_;
    RayCaster ray_caster_;
    std::unique_ptr<MeshRasteriser> rasteriser_;  // made at the first view that needs it
    PredictedView view_;
    std::string warning_;
};

}  // namespace tessera
