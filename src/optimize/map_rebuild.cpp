#include "optimize/map_rebuild.h"

#include <algorithm>

namespace tessera {

MapRebuild::MapRebuild(const FieldSettings& settings, std::vector<Eigen::Isometry3d> T_world_keyframe,
                       std::unique_ptr<LabelMapper> labels)
    : map_(std::make_unique<BlockMap>(settings.map)),
      integrator_(settings.fusion, settings.camera),
      camera_(settings.camera),
      preparation_(settings.preparation),
      T_world_keyframe_(std::move(T_world_keyframe)),
      labels_(std::move(labels)) {
    if (labels_) map_->EnableLabels();
}

bool MapRebuild::Step(FrameStore& store, int frames) {
    const std::vector<StoredFrame>& stored = store.frames();
    auto next = std::ranges::lower_bound(stored, next_ordinal_, {}, &StoredFrame::ordinal);
    for (int i = 0; i < frames && next != stored.end(); ++i, ++next) {
        next_ordinal_ = next->ordinal + 1;
        if (!store.LoadPrepared(*next, camera_, preparation_, frame_, prepared_).ok()) continue;  // the map does without
        Integrator::View view = next->view;
        view.T_world_camera = T_world_keyframe_[static_cast<std::size_t>(next->keyframe)] * next->T_keyframe_camera;
        integrator_.Integrate(prepared_, view, *map_);
        if (labels_ && next->detections) labels_->Label(*next->detections, frame_.depth_m, view.T_world_camera, *map_);
    }
    return next == stored.end();
}

}  // namespace tessera
