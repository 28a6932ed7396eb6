// How PagingStage brings the map below its limit.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scan/scan_file.h"
#include "system/paging_stage.h"

namespace tessera {

bool PagingStage::AllSaved(const ResidentCubes::Cube& cube) const {
    return std::ranges::all_of(resident_.blocks(cube),
                               [&](BlockId id) { return scan_.Has(mapping_.blocks(), id); });
}

bool PagingStage::IsHeld(const BlockCoord& cube) const {
    if (IsExpected(cube)) return true;
    return std::ranges::any_of(
        held_, [&](const Held& held) { return viewed_.Outside_m(held.T_world_camera, cube) <= 0; });
}

// Chooses enough cubes to release, among those that may be released. Warns if there are too few.
std::vector<ResidentCubes::Cube> PagingStage::ChooseLeaving() {
    const BlockMap& map = mapping_.blocks();
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
            (!wait_ && !AllSaved(cube)))
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

void PagingStage::Release() {
    if (store_ && scan_.HasReplaced()) store_.reset();
    const auto bytes = static_cast<double>(mapping_.blocks().bytes());
    if (bytes <= limit_bytes_ || !T_world_camera_) return;
    // The order matters: a failed checkpoint is no longer in progress.
    if ((!wait_ && !scan_.idle()) || scan_.failed()) return;
    const std::vector<ResidentCubes::Cube> leaving = ChooseLeaving();
    if (leaving.empty()) return;
    if (wait_) {
        const bool saved =
            std::ranges::all_of(leaving, [&](const auto& cube) { return AllSaved(cube); });
        if (!scan_.Settle(mapping_, !saved)) return;
    }
    paged_ = true;
    for (const ResidentCubes::Cube& cube : leaving) {
        const std::span<const BlockId> blocks = resident_.blocks(cube);
        mapping_.Release(blocks);
        scan_.Touch(blocks);
        away_[CubeKey(cube.cube)] = static_cast<std::int32_t>(blocks.size());
    }
}

void PagingStage::ReleaseHold(std::int64_t frame) {
    while (!held_.empty() && held_.front().frame <= frame) held_.pop_front();
}

Status PagingStage::ReturnAll() {
    if (store_) PutBackFromStore();
    if (away_.empty() && lost_.empty()) return Status::Ok();
    Result<std::unique_ptr<CubeReader>> reader = CubeReader::Open(scan_.path());
    if (!reader.ok()) return reader.status();
    const CubeCounts cubes = away_;
    PutBack(cubes, [&](std::int64_t key, BlockCopies& blocks) {
        return reader.value()->Read(key, blocks);
    });
    return lost_.empty() ? Status::Ok()
                         : DamagedScan(scan_.path(),
                                       "blocks that were moved out of memory cannot be read back");
}

std::string PagingStage::MissingText() const {
    if (away_.empty() && lost_.empty()) return {};
    return fmt::format(
        "; parts of the map that are only in {} are missing: `tessera export` writes all of it",
        scan_.path());
}

}  // namespace tessera
