#include "system/path_log.h"

#include <algorithm>

namespace tessera {

PathRecord RecordOf(const Frame& frame, const TrackedFrame& tracked) {
    PathRecord record;
    record.index = frame.index;
    record.stamp_s = frame.stamp_s;
    record.status = tracked.report.track.status;
    record.fused = tracked.report.fused;
    record.T_world_camera_truth = frame.T_world_camera;
    if (record.tracked()) record.T_reference_camera = tracked.report.track.T_world_camera;
    return record;
}

void PathLog::Add(std::int64_t number, const PathRecord& record, ScanCheckpoint& into) {
    if (loops_ && record.tracked())
        waiting_.emplace_back(number, record);
    else
        into.path.emplace_back(number, record);
}

void PathLog::Place(LoopChanges& news, ScanCheckpoint& into) {
    for (const PathPose& passage : news.passages)
        while (!waiting_.empty()) {
            auto [number, record] = waiting_.front();
            waiting_.pop_front();
            // Otherwise loop closure has skipped this frame.
            const bool here = record.stamp_s == passage.stamp_s;
            if (here) {
                record.keyframe = passage.keyframe;
                record.T_reference_camera = passage.T_keyframe_camera;
                placed_.push_back({record.index, number});
            }
            into.path.emplace_back(number, record);
            if (here) break;
        }
    for (StoredFrame& frame : news.frames) {
        const auto placed =
            std::ranges::lower_bound(placed_, frame.frame_index, {}, &Numbered::frame_index);
        if (placed == placed_.end() || placed->frame_index != frame.frame_index) continue;
        std::erase_if(into.raw_frames,
                      [&](const auto& raw) { return raw.first == placed->number; });
        FrameRecord record{frame.frame_index, frame.stamp_s, frame.colour_stamp_s, true,
                           std::move(frame)};
        into.frames.emplace_back(placed->number, std::move(record));
    }
}

void PathLog::Move(const Eigen::Isometry3d& T_new_old) {
    for (auto& [number, record] : waiting_)
        record.T_reference_camera = Normalised(T_new_old * record.T_reference_camera);
}

void PathLog::AddWaiting(ScanCheckpoint& into) const {
    into.path.insert(into.path.end(), waiting_.begin(), waiting_.end());
}

void PathLog::Clear() {
    waiting_.clear();
    placed_.clear();
}

}  // namespace tessera
