#include "scan/shown_scan.h"

#include <algorithm>

#include "optimize/scan_parts.h"

namespace tessera {

bool ScanContent::Shows(const Eigen::Isometry3d& T_map) const {
    return keyframes.empty() || std::ranges::any_of(keyframes, [&](const Keyframe& keyframe) {
               return !LeftOut(keyframe.id) && InOnePart(keyframe.T_map_camera, T_map) &&
                      InOnePart(keyframe.T_map_camera, keyframe.T_world_camera);
           });
}

std::optional<Eigen::Isometry3d> ScanContent::PoseOf(const PathRecord& record) const {
    if (!record.tracked()) return std::nullopt;
    const Eigen::Isometry3d& T = record.T_reference_camera;
    if (record.keyframe < 0) return Shows(T) ? std::optional(T) : std::nullopt;
    if (LeftOut(record.keyframe)) return std::nullopt;
    return Normalised(keyframes[static_cast<std::size_t>(record.keyframe)].T_world_camera * T);
}

std::vector<StampedPose> ScanContent::Path() const {
    std::vector<StampedPose> poses;
    for (const PathRecord& record : path)
        if (const std::optional<Eigen::Isometry3d> T = PoseOf(record))
            poses.push_back({record.stamp_s, *T});
    return poses;
}

std::optional<StampedPose> ScanContent::LastPose() const {
    for (auto record = path.rbegin(); record != path.rend(); ++record) {
        if (!record->tracked()) continue;
        const Eigen::Isometry3d& T = record->T_reference_camera;
        if (record->keyframe < 0) return StampedPose{record->stamp_s, T};
        return StampedPose{
            record->stamp_s,
            Normalised(keyframes[static_cast<std::size_t>(record->keyframe)].T_map_camera * T)};
    }
    return std::nullopt;
}

std::vector<StampedPose> ScanContent::Truth() const {
    std::vector<StampedPose> poses;
    for (const PathRecord& record : path)
        if (record.T_world_camera_truth)
            poses.push_back({record.stamp_s, *record.T_world_camera_truth});
    return poses;
}

void RemoveHiddenBlocks(ScanContent& scan) {
    if (!scan.map) return;
    BlockMap& map = *scan.map;
    const double block_m = kBlockSide * map.config().voxel_size_m;
    for (BlockId id = 1; id < map.size(); ++id) {
        if (map.IsFree(id)) continue;
        const BlockCoord c = map.coord(id);
        const Eigen::Vector3d at_m = block_m * Eigen::Vector3d(c.x, c.y, c.z);
        if (!scan.Shows(Eigen::Isometry3d(Eigen::Translation3d(at_m)))) map.Release(id);
    }
}

Result<ScanContent> ReadScanToShow(const std::string& path, const ScanParts& parts) {
    Result<ScanContent> scan = ReadScan(path, parts);
    if (scan.ok()) RemoveHiddenBlocks(scan.value());
    return scan;
}

}  // namespace tessera
