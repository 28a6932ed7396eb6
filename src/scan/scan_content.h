// Everything that a scan file holds, in memory: what it takes to go on, to look at it, or to hand
// it out as other files.
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
    bool finished = false;  // the run that wrote it last came to its end
    // Null unless asked for; its blocks have the ids that they had.
    std::unique_ptr<BlockMap> map;
    std::vector<PathRecord> path;
    std::vector<Keyframe> keyframes;
    std::vector<FrameRecord> frames;  // if asked for, by increasing time
    LoopProgress loops;
    // TrackingStage's and LabelMapper's states, as they gave them; perhaps empty.
    Bytes tracking, labels;

    // T_world_camera of one of the path's frames as it is known now; nothing if it was not tracked.
    std::optional<Eigen::Isometry3d> PoseOf(const PathRecord& record) const;
    // The same of all tracked frames, and the source's truth where it has one.
    std::vector<StampedPose> Path() const;
    std::vector<StampedPose> Truth() const;
    // Where the last tracked frame's camera was in the map as it is here; nothing if no frame was
    // tracked.
    std::optional<StampedPose> LastPose() const;
};

struct ScanParts {
    bool map = true, frames = false;
    bool labels = false;  // the map gets room for labels even if the file has none
};

// Errors name the file and what to do: damage of any kind is found and refused, never passed on.
// What is not asked for is not looked at.
Result<ScanContent> ReadScan(const std::string& path, const ScanParts& parts);
Result<ScanContent> ReadScan(ScanFile& file, const ScanParts& parts);
Result<ScanMeta> ReadScanMeta(const std::string& path);

// Every stored frame's record, in order, one at a time in memory.
Status ReadScanFrames(ScanFile& file, const std::function<Status(FrameRecord&&)>& take);

}  // namespace tessera
