// How PagingStage brings the map below its limit.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scan/scan_file.h"
#include "system/paging_stage.h"

namespace tessera {

bool PagingStage::AllSaved(const ResidentCubes::Cube& cube, const BlockMap& map,
                           const ScanStage& scan) const {
    return std::ranges::all_of(resident_.blocks(cube),
                               [&](BlockId id) { return scan.Has(map, id); });
}

bool PagingStage::IsHeld(const BlockCoord& cube) const {
    if (IsExpected(cube)) return true;
    return std::ranges::any_of(
        held_, [&](const Held& held) { return viewed_.Outside_m(held.T_world_camera, cube) <= 0; });
}

// Chooses enough cubes to release, among those that may be released. Warns if there are too few.
std::vector<ResidentCubes::Cube> PagingStage::ChooseLeaving(const BlockMap& map,
                                                            const ScanStage& scan) {
    const auto bytes = static_cast<double>(map.bytes());
    const double block_bytes = bytes / static_cast<double>(map.count() + 1);
    // Bytes left after releasing the chosen cubes, and after releasing all possible ones.
    double rest_bytes = bytes, least_bytes = bytes;
    std::vector<ResidentCubes::Cube> leaving;
    resident_.Gather(map);
    for (const ResidentCubes::Cube& cube : resident_.Farthest(viewed_, *T_world_camera_)) {
        const double cube_bytes = block_bytes * static_cast<double>(cube.last - cube.first);
        least_bytes -= cube_bytes;
        if (rest_bytes <= kRefill * limit_bytes_ || IsHeld(cube.cube) ||
            (!wait_ && !AllSaved(cube, map, scan)))
            continue;
        rest_bytes -= cube_bytes;
        leaving.push_back(cube);
    }
    if (least_bytes > limit_bytes_ && !std::exchange(told_small_, true))
        notices_.Tell(fmt::format(
            "mapping.memory_limit_mb: {:.0f} MB is not enough for what the camera may see from one "
            "place, {:.0f} MB; raise the limit, or lower frame.max_depth_m",
            limit_bytes_ / 1e6, least_bytes / 1e6));
    return leaving;
}

void PagingStage::Release(MappingStage& mapping, ScanStage& scan) {
    const BlockMap& map = mapping.map();
    if (store_ && scan.HasReplaced()) store_.reset();
    if (static_cast<double>(map.bytes()) <= limit_bytes_ || !T_world_camera_) return;
    // The order matters: a failed checkpoint is no longer in progress.
    if ((!wait_ && !scan.idle()) || scan.failed()) return;
    const std::vector<ResidentCubes::Cube> leaving = ChooseLeaving(map, scan);
    if (leaving.empty()) return;
    if (wait_) {
        const bool saved = std::ranges::all_of(
            leaving, [&](const auto& cube) { return AllSaved(cube, map, scan); });
        if (!scan.Settle(mapping, !saved)) return;
    }
    paged_ = true;
    for (const ResidentCubes::Cube& cube : leaving) {
        const std::span<const BlockId> blocks = resident_.blocks(cube);
        mapping.Release(blocks);
        scan.Released(blocks);
        away_[CubeKey(cube.cube)] = static_cast<std::int32_t>(blocks.size());
    }
}

void PagingStage::ReleaseHold(std::int64_t frame) {
    while (!held_.empty() && held_.front().frame <= frame) held_.pop_front();
}

Status PagingStage::ReturnAll(MappingStage& mapping, ScanStage& scan) {
    if (store_) ReturnFromStore(mapping, scan);
    if (away_.empty() && lost_.empty()) return Status::Ok();
    Result<std::unique_ptr<CubeReader>> reader = CubeReader::Open(scan.path());
    if (!reader.ok()) return reader.status();
    std::vector<std::int64_t> keys;
    for (const auto& [key, blocks] : away_) keys.push_back(key);
    std::ranges::sort(keys);
    StoredCube cube;
    for (const std::int64_t key : keys) {
        cube.key = key;
        cube.status = reader.value()->Read(key, cube.blocks);
        Put(cube, mapping, scan);
    }
    return lost_.empty() ? Status::Ok()
                         : DamagedScan(scan.path(),
                                       "blocks that were moved out of memory cannot be read back");
}

std::string PagingStage::MissingText(const ScanStage& scan) const {
    if (away_.empty() && lost_.empty()) return {};
    return fmt::format(
        "; parts of the map that are only in {} are missing: `tessera export` writes all of it",
        scan.path());
}

}  // namespace tessera
