#include "system/frame_plan.h"

#include <fmt/format.h>

#include <algorithm>

namespace tessera {

FramePlan::FramePlan(std::vector<MethodSwitch> switches, std::vector<StampedPose> poses,
                     const std::string& poses_file)
    : switches_(std::move(switches)), poses_(std::move(poses)), poses_file_(poses_file) {
    std::ranges::stable_sort(switches_, {}, &MethodSwitch::frame);
}

void FramePlan::Select(const Frame& frame, TrackingStage& stage) {
    for (; next_switch_ < switches_.size() && switches_[next_switch_].frame <= frame.index;
         ++next_switch_)
        stage.Select(switches_[next_switch_].method);
}

void FramePlan::Track(const Frame& frame, const BlockMap& map, TrackingStage& stage,
                      TrackedFrame& tracked) {
    if (poses_.empty()) return stage.Track(frame, map, std::nullopt, tracked);
    if (const auto T_world_camera = PoseAt(poses_, frame.stamp_s))
        return stage.Track(frame, map, T_world_camera, tracked);
    tracked.report = {};
    tracked.report.index = frame.index;
    tracked.report.stamp_s = frame.stamp_s;
    tracked.report.track.reason = fmt::format(
        "{} has no pose near this time: its poses are from {:.3f} to {:.3f} s; this frame: {:.3f} "
        "s",
        poses_file_, poses_.front().stamp_s, poses_.back().stamp_s, frame.stamp_s);
    tracked.to_fuse = false;
}

}  // namespace tessera
