#include "optimize/frame_keeper.h"

#include <utility>

namespace tessera {

FrameKeeper::FrameKeeper(const PinholeCamera& camera, std::size_t memory_limit_bytes,
                         double depth_units_per_m, bool average)
    : average_frames_(average), average_(camera), store_(memory_limit_bytes, depth_units_per_m) {}

Status FrameKeeper::Add(const Frame& frame, int id, bool first, bool alone,
                        const Eigen::Isometry3d& T_keyframe_camera, const Integrator::View& view) {
    const bool averaged = !first && !alone && average_frames_;
    if (averaged && average_.Add(frame, T_keyframe_camera, view)) return Status::Ok();
    if (Status stored = StoreAverage(); !stored.ok()) return stored;
    if (!averaged) return store_.Add(frame, id, first, T_keyframe_camera, view);
    average_.Begin(frame, T_keyframe_camera, view);
    keyframe_ = id;
    return Status::Ok();
}

Status FrameKeeper::StoreAverage() {
    if (average_.empty()) return Status::Ok();
    return store_.Add(average_.Take(), keyframe_, false, average_.T_keyframe_camera(),
                      average_.view());
}

// A map without these frames is still a map.
void FrameKeeper::StoreLatest() {
    if (Status stored = StoreAverage(); !stored.ok()) trouble_ = stored.message();
}

std::string FrameKeeper::TakeTrouble() {
    return trouble_.empty() ? store_.TakeTrouble() : std::exchange(trouble_, {});
}

}  // namespace tessera
