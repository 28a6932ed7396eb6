#include "system/loop_journal.h"

#include <algorithm>
#include <utility>

#include "core/se3.h"

namespace tessera {

// Frames that loop closure had not yet processed keep their pose in the map.
LoopCloser::Memory TakeLoopMemory(ScanContent& scan) {
    LoopCloser::Memory memory;
    memory.graph.keyframes = std::move(scan.keyframes);
    memory.graph.edges = std::move(scan.loops.edges);
    for (const PathRecord& record : scan.path) {
        if (!record.tracked() || memory.graph.keyframes.empty()) continue;
        if (record.keyframe >= 0) {
            memory.graph.passages.push_back(
                {record.stamp_s, record.keyframe, record.T_reference_camera, record.fused});
        } else if (!memory.graph.passages.empty()) {
            const int last = memory.graph.passages.back().keyframe;
            const Eigen::Isometry3d& T_map_keyframe =
                memory.graph.keyframes[static_cast<std::size_t>(last)].T_map_camera;
            if (InOnePart(T_map_keyframe, record.T_reference_camera))
                memory.graph.passages.push_back(
                    {record.stamp_s, last,
                     Normalised(T_map_keyframe.inverse() * record.T_reference_camera),
                     record.fused});
        }
    }
    for (FrameRecord& frame : scan.frames)
        if (frame.in_store) memory.frames.push_back(std::move(frame.stored));
    memory.next_ordinal = scan.loops.next_ordinal;
    for (const StoredFrame& frame : memory.frames)
        memory.next_ordinal = std::max(memory.next_ordinal, frame.ordinal + 1);
    memory.graph.loops = scan.loops.loops;
    memory.graph.corrected = scan.loops.corrected;
    return memory;
}

void LoopJournal::Begin(const LoopCloser& closer) {
    begun_ = true;
    passages_ = closer.graph().passages().size();
    next_ordinal_ = closer.store().next_ordinal();
    touched_.clear();
    poses_.clear();
    overlaps_.clear();
    const Keyframes& keyframes = closer.keyframes();
    for (int id = 0; id < keyframes.size(); ++id) {
        poses_.push_back({keyframes[id].T_map_camera, keyframes[id].T_world_camera});
        overlaps_.push_back(keyframes[id].overlaps.size());
    }
}

LoopChanges LoopJournal::Take(const LoopCloser& closer, std::size_t most_frames) {
    if (!std::exchange(begun_, true)) most_frames = kAllFrames;
    LoopChanges news;
    news.passages.assign(closer.graph().passages().begin() + static_cast<std::ptrdiff_t>(passages_),
                         closer.graph().passages().end());
    passages_ = closer.graph().passages().size();
    for (const std::int64_t index : std::exchange(touched_, {}))
        if (const StoredFrame* frame = closer.store().Find(index);
            frame != nullptr && frame->ordinal < next_ordinal_)
            news.frames.push_back(*frame);
    const std::vector<StoredFrame>& frames = closer.store().frames();
    const auto first_new =
        std::ranges::lower_bound(frames, next_ordinal_, {}, &StoredFrame::ordinal);
    const auto count = std::min(most_frames, static_cast<std::size_t>(frames.end() - first_new));
    news.frames.insert(news.frames.end(), first_new,
                       first_new + static_cast<std::ptrdiff_t>(count));
    if (count > 0) next_ordinal_ = news.frames.back().ordinal + 1;
    const Keyframes& keyframes = closer.keyframes();
    for (int id = 0; id < keyframes.size(); ++id) {
        const KeyframePoses poses{keyframes[id].T_map_camera, keyframes[id].T_world_camera};
        const auto at = static_cast<std::size_t>(id);
        const std::size_t overlaps = keyframes[id].overlaps.size();
        const bool fresh = at == poses_.size();
        if (fresh) {
            poses_.emplace_back();
            overlaps_.emplace_back();
        }
        if (fresh || overlaps != overlaps_[at]) news.keyframes.push_back(keyframes[id]);
        overlaps_[at] = overlaps;
        if (!fresh && poses_[at] == poses) continue;
        poses_[at] = poses;
        news.poses.emplace_back(id, poses);
    }
    news.progress = TakeProgress(closer, most_frames >= frames.size());
    return news;
}

std::optional<LoopProgress> LoopJournal::TakeProgress(const LoopCloser& closer, bool with_ordinal) {
    const ScanGraph& graph = closer.graph();
    const Progress now{graph.edges().size(), graph.loops(), graph.corrected(),
                       closer.store().next_ordinal()};
    Progress before = progress_.value_or(Progress{});
    if (!with_ordinal) before.next_ordinal = now.next_ordinal;
    if (progress_ && before == now) return std::nullopt;
    progress_ = now;
    return LoopProgress{graph.edges(), now.next_ordinal, now.loops, now.corrected};
}

}  // namespace tessera
