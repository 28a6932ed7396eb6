#include "system/frame_tracking.h"

#include <algorithm>

namespace tessera {

TrackingResume TrackingResume::Of(const ScanPlan& plan) {
    const ScanContent& scan = *plan.resumed;
    TrackingResume resume{scan.tracking, scan.LastPose(), scan.progress.last_stamp_s,
                          plan.only_localise()};
    const auto taken = [&scan](int part) {
        return std::ranges::any_of(scan.keyframes, [part](const Keyframe& keyframe) {
            return InOnePart(keyframe.T_map_camera, PartStart(part));
        });
    };
    resume.parts = kMostParts;
    while (resume.parts > 0 && !taken(resume.parts)) --resume.parts;
    return resume;
}

// Upright as the camera was last, for the window.
void FrameTracking::BeginPart() {
    Eigen::Isometry3d T_world_start = PartStart(++parts_);
    T_world_start.linear() = stage_.last()->T_world_camera.linear();
    stage_.BeginPart(T_world_start);
    watch_.Clear();
}

}  // namespace tessera
