#include "system/viewer_feed.h"

#include <cmath>
#include <utility>

#include "core/stopwatch.h"

namespace tessera {

double ViewerFeed::Send(const Frame& frame, const FrameReport& report, MappingStage& mapping) {
    if (viewer_ == nullptr) return 0;
    stamp_s_ = frame.stamp_s;
    SendImages(frame, report, mapping);
    return SendMesh(mapping);
}

// Until the window has taken the earlier meshes, changes wait in the mesher.
double ViewerFeed::SendMesh(MappingStage& mapping) {
    if (viewer_ == nullptr || !HasRoom()) return 0;
    Stopwatch watch;
    MeshUpdate update;
    waiting_ = mapping.UpdateMesh(mesh_blocks_, update);
    if (update.clear || !update.blocks.empty()) viewer_->meshes.TryPush(std::move(update));
    SendObjects(mapping);
    return watch.LapMs();
}

bool ViewerFeed::SendFinalMesh(MappingStage& mapping) {
    constexpr int kBlocks = 1000;  // no frame waits any more
    if (viewer_ == nullptr) return true;
    if (!std::exchange(final_begun_, true)) mapping.MeshAgain();
    while (!final_sent_ && HasRoom()) {
        MeshUpdate update;
        final_sent_ = update.last = mapping.UpdateMesh(kBlocks, update) == 0;
        viewer_->meshes.TryPush(std::move(update));
    }
    return final_sent_;
}

// At most twice a second, by the frames' stamps, so that lockstep sends the same on every run.
void ViewerFeed::SendObjects(const MappingStage& mapping) {
    constexpr double kPeriod_s = 0.5;
    if (mapping.labels_revision() == objects_revision_ || !viewer_->objects.empty()) return;
    if (objects_stamp_s_ && std::abs(stamp_s_ - *objects_stamp_s_) < kPeriod_s) return;
    objects_revision_ = mapping.labels_revision();
    viewer_->objects.Push(mapping.MeasureObjects());
    objects_stamp_s_ = stamp_s_;
}

void ViewerFeed::SendImages(const Frame& frame, const FrameReport& report,
                            const MappingStage& mapping) {
    if (!viewer_->images.empty()) return;
    ImageUpdate images;
    images.frame = std::make_shared<Frame>(frame);
    images.moving = report.moving;
    if (show_prediction_ && report.tracked()) {
        constexpr int kStep = 4;
        auto view = std::make_shared<PredictedView>();
        mapping.Predict(report.track.T_world_camera, kStep, *view);
        images.predicted = std::move(view);
    }
    viewer_->images.Push(std::move(images));
}

}  // namespace tessera
