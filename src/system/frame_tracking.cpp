#include "system/frame_tracking.h"

#include <algorithm>

namespace tessera {

TrackingResume TrackingResume::Of(const ScanPlan& plan) {
    const ScanContent& scan = *plan.resumed;
    TrackingResume resume{.state = scan.tracking, .last = scan.LastPose()};
    if (resume.last) resume.last_seen_s = resume.last->stamp_s;
    resume.lost = !scan.path.empty() && !scan.path.back().tracked();
    resume.only_localise = plan.only_localise();
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
