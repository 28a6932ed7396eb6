#include "system/scan_restore.h"

#include <algorithm>
#include <utility>

#include "core/se3.h"

namespace tessera {

Status RestoreMap(const std::string& path, ScanContent& scan, MappingStage& mapping) {
    mapping.Resume(std::move(scan.map), scan.progress.fused_frames);
    StateReader labels(scan.labels);
    if (!scan.labels.empty() && !mapping.LoadLabels(labels))
        return Status::Error(path +
                             ": its labels have other classes; give the same --labels and "
                             "labels.classes as when the scan was created");
    return Status::Ok();
}

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

}  // namespace tessera
