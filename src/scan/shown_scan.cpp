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

void RemoveHiddenBlocks(ScanContent& scan) {
    if (!scan.map) return;
    BlockMap& map = *scan.map;
    for (BlockId id = 1; id < map.size(); ++id)
        if (!map.IsFree(id) && !scan.Shows(PlaceOf(map, id))) map.Release(id);
}

Result<ScanContent> ReadScanToShow(const std::string& path, const ScanParts& parts) {
    Result<ScanContent> scan = ReadScan(path, parts);
    if (scan.ok()) RemoveHiddenBlocks(scan.value());
    return scan;
}

}  // namespace tessera
