// The content of a scan file, in memory: everything needed to resume, view or export the scan.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/se3.h"
#include "mapping/block_map.h"
#include "scan/scan_file.h"
#include "scan/scan_records.h"

namespace tessera {

struct ScanContent {
    ScanMeta meta;
    ScanProgress progress;
    bool finished = false;  // the last run that wrote it ended normally
    // Null unless requested. The blocks have their original ids.
    std::unique_ptr<BlockMap> map;
    std::vector<PathRecord> path;
    std::vector<Keyframe> keyframes;
    std::vector<bool> left_out;       // by keyframe, see OutsideTheLargest; empty: none
    std::vector<FrameRecord> frames;  // if requested, by increasing time
    LoopProgress loops;
    std::string source_name;  // of the last session, to which progress.last_index belongs
    // Saved states of TrackingStage and LabelMapper; may be empty.
    Bytes tracking, labels;

    bool LeftOut(int keyframe) const {
        return !left_out.empty() && left_out[static_cast<std::size_t>(keyframe)];
    }
    // Whether a place in the map belongs to what is shown and exported. The scan of a run that was
    // killed may hold parts that nothing joins with the rest, far away in the map
    // (optimize/scan_parts.h): they are left out, and so is a part that was joined but is not in
    // place yet.
    bool Shows(const Eigen::Isometry3d& T_map) const;
    // Removes the blocks that are not shown from the map, if there is one.
    void RemoveHiddenBlocks();
    // The current T_world_camera of a frame of the path; nullopt if it was not tracked, or is in a
    // part of the scan that is left out.
    std::optional<Eigen::Isometry3d> PoseOf(const PathRecord& record) const;
    // The poses of all frames that have one, and the source's ground truth where available.
    std::vector<StampedPose> Path() const;
    std::vector<StampedPose> Truth() const;
    // The last tracked frame's camera pose in the map as stored here; nullopt if no frame was
    // tracked.
    std::optional<StampedPose> LastPose() const;
};

struct ScanParts {
    bool map = true, frames = false;
    bool labels = false;  // allocate labels in the map even if the file has none
};

// Errors name the file and what to do. Any kind of damage is detected and refused. Parts that are
// not requested are not checked.
Result<ScanContent> ReadScan(const std::string& path, const ScanParts& parts);
Result<ScanContent> ReadScan(ScanFile& file, const ScanParts& parts);
Result<ScanMeta> ReadScanMeta(const std::string& path);
// As it is shown and exported: without hidden blocks.
Result<ScanContent> ReadScanToShow(const std::string& path, const ScanParts& parts);

}  // namespace tessera
