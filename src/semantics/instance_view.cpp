#include "semantics/instance_view.h"

#include <tbb/parallel_for.h>

#include "semantics/label_near.h"

namespace tessera {

void InstanceView::Select(LabelPrediction source) {
    if (source == source_) return;
    source_ = source;
    rasteriser_.reset();
    warning_.clear();
}

void InstanceView::Predict(const BlockMap& map, const PinholeCamera& camera,
                           const Eigen::Isometry3d& T_world_camera, float min_depth_m,
                           float max_depth_m, Image<InstanceId>& shown) {
    if (Rasterise(map, camera, T_world_camera, min_depth_m, max_depth_m, shown)) return;
    ray_caster_.Predict(map, camera, T_world_camera, min_depth_m, max_depth_m, view_);
    shown.Resize(camera.width, camera.height);
    tbb::parallel_for(0, camera.height, [&](int y) {
        for (int x = 0; x < camera.width; ++x) {
            const float z = view_.depth_m(x, y);
            shown(x, y) = z > 0
                              ? LabelNear(map, T_world_camera * camera.Unproject(x, y, z)).instance
                              : InstanceId{0};
        }
    });
}

// Returns false if rays must be cast.
bool InstanceView::Rasterise(const BlockMap& map, const PinholeCamera& camera,
                             const Eigen::Isometry3d& T_world_camera, float min_depth_m,
                             float max_depth_m, Image<InstanceId>& shown) {
    if (source_ != LabelPrediction::kRaster || !warning_.empty()) return false;
    if (!rasteriser_) {
        auto made = MeshRasteriser::Create(MeshConfig(),
                                           [](const BlockMap& labelled, const BlockMesh& owner,
                                              const BlockMesh::Vertex& v) -> InstanceId {
                                               return LabelNear(labelled, owner, v).instance;
                                           });
        if (!made.ok()) return GiveUp(made.status()), false;
        rasteriser_ = std::move(made.value());
    }
    rasteriser_->Predict(map, camera, T_world_camera, min_depth_m, max_depth_m, view_);
    if (!rasteriser_->status().ok()) return GiveUp(rasteriser_->status()), false;
    shown = rasteriser_->labels();
    return true;
}

void InstanceView::GiveUp(const Status& status) {
    warning_ = "predicting labels by ray casting: " + status.message();
    rasteriser_.reset();
}

void InstanceView::Voted(std::span<const BlockId> blocks) {
    if (rasteriser_) rasteriser_->LabelAgain(blocks);
}

}  // namespace tessera
