#include "system/paging_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "scan/scan_file.h"

namespace tessera {
namespace {

constexpr double kAhead_m = 1.0;   // so much before the camera may see a cube it is asked for
constexpr double kKeep_m = 1.25;   // and so far beyond that it may go: else it would come and go
constexpr double kRefill = 0.9;    // of the limit, that a release goes down to
constexpr std::int64_t kFrames = 8;  // after which a cube that was asked for is put in, lockstep
constexpr std::size_t kMostPerFrame = 8;  // cubes that live puts in

// Fusion reads and writes so far around what is measured, and tracking around that.
double MarginOf(const BlockMap::Config& map) {
    constexpr double kPoses_m = 0.3;  // tracking tries poses around the one that it finds
    return map.truncation_m + 2 * kBlockSide * map.voxel_size_m + kPoses_m;
}

// How far the camera measures.
double RangeOf(const PipelineConfig& config, const PinholeCamera& camera) {
    double corner_m = 0;
    for (const double u : {-0.5, camera.width - 0.5})
        for (const double v : {-0.5, camera.height - 0.5})
            corner_m = std::max(corner_m, camera.Unproject(u, v, config.frame.max_depth_m).norm());
    return corner_m;
}

}  // namespace

PagingStage::PagingStage(const PipelineConfig& config, const PinholeCamera& camera, std::unique_ptr<Pager> pager, bool wait)
    : limit_bytes_(config.paging.memory_limit_mb * 1e6),
      cube_m_(kCubeBlocks * kBlockSide * config.map.voxel_size_m),
      margin_m_(MarginOf(config.map)),
      reach_m_(RangeOf(config, camera) + margin_m_),
      wait_(wait),
      pager_(std::move(pager)) {}

// How far a cube is from the half ball that the camera may read; at most 0: it is in it.
double PagingStage::Outside(const BlockCoord& cube) const {
    const Eigen::Vector3d camera = T_world_camera_->translation();
    const Eigen::Vector3d low = Eigen::Vector3d(cube.x, cube.y, cube.z) * cube_m_;
    const Eigen::Vector3d high = low.array() + cube_m_;
    const double away_m = (camera - camera.cwiseMax(low).cwiseMin(high)).norm();
    const double ahead_m = T_world_camera_->linear().col(2).dot(0.5 * (low + high) - camera) + 0.866 * cube_m_;
    return std::max(away_m - reach_m_, -ahead_m - margin_m_);
}

// What is near and away, and not asked for.
void PagingStage::Plan() {
    constexpr double kLimit = kBlockLimit / kCubeBlocks;
    wanted_.clear();
    for (Asked& asked : asked_) asked.outside_m = Outside(CubeOfKey(asked.key));
    if (away_.size() == asked_.size()) return;
    const Eigen::Array3d camera = T_world_camera_->translation();
    const auto cube_of = [&](double offset_m) -> Eigen::Array3d {
        return ((camera + offset_m) / cube_m_).floor().max(-kLimit).min(kLimit - 1);
    };
    const Eigen::Array3d first = cube_of(-reach_m_ - kAhead_m), last = cube_of(reach_m_ + kAhead_m);
    if ((last - first + 1).prod() < static_cast<double>(away_.size())) {
        const Eigen::Array3i low = first.cast<int>(), high = last.cast<int>();
        for (int z = low.z(); z <= high.z(); ++z)
            for (int y = low.y(); y <= high.y(); ++y)
                for (int x = low.x(); x <= high.x(); ++x) Want({x, y, z});
    } else {
        for (const auto& [key, blocks] : away_) Want(CubeOfKey(key));
    }
    std::ranges::sort(wanted_, {}, [](const Asked& a) { return std::pair(a.outside_m, a.key); });
}

void PagingStage::Want(const BlockCoord& cube) {
    const double outside_m = Outside(cube);
    if (outside_m > kAhead_m) return;
    const std::int64_t key = CubeKey(cube);
    if (!away_.contains(key) || std::ranges::find(asked_, key, &Asked::key) != asked_.end()) return;
    wanted_.push_back({key, outside_m, 0});
}

void PagingStage::Ask() {
    while (!wanted_.empty() && pager_->under_way() < Pager::kMostAsked) {
        wanted_.front().frame = frame_;
        pager_->Ask(wanted_.front().key);
        asked_.push_back(wanted_.front());
        wanted_.pop_front();
    }
}

// Something that is to come is in what the camera may see, or at most so far outside.
bool PagingStage::Needs(double further_m) const {
    const auto needed = [&](const Asked& cube) { return cube.outside_m <= further_m; };
    return std::ranges::any_of(asked_, needed) || std::ranges::any_of(wanted_, needed);
}

// The next camera is as far from the last one as that was from the one before, about: tracking starts there.
void PagingStage::BeginFrame(MappingStage& mapping, ScanStage& scan) {
    ++frame_;
    if (T_world_camera_) Bring(std::min(step_m_, kAhead_m), mapping, scan);
}

bool PagingStage::AfterTracking(TrackedFrame& tracked, MappingStage& mapping, ScanStage& scan) {
    if (!tracked.report.tracked() && !tracked.to_fuse) return false;
    const Eigen::Isometry3d& T_world_camera = tracked.report.track.T_world_camera;
    if (T_world_camera_) step_m_ = (T_world_camera.translation() - T_world_camera_->translation()).norm();
    T_world_camera_ = T_world_camera;
    return !Bring(0, mapping, scan) && std::exchange(tracked.to_fuse, false);
}

// False: part of what the camera may see is not there.
bool PagingStage::Bring(double further_m, MappingStage& mapping, ScanStage& scan) {
    if (!away_.empty()) {
        Plan();
        Ask();
        TakeWhatCame(further_m, mapping, scan);
    }
    return !Needs(0) && std::ranges::none_of(lost_, [&](std::int64_t key) { return Outside(CubeOfKey(key)) <= 0; });
}

void PagingStage::TakeWhatCame(double further_m, MappingStage& mapping, ScanStage& scan) {
    for (std::size_t taken = 0; !asked_.empty() && (wait_ || taken < kMostPerFrame); ++taken) {
        if (wait_ && !Needs(further_m) && frame_ - asked_.front().frame < kFrames) return;
        std::unique_ptr<StoredCube> cube = wait_ ? pager_->Take() : pager_->TryTake();
        if (!cube) return;
        asked_.pop_front();
        Put(*cube, mapping, scan);
        pager_->Give(std::move(cube));
        Ask();
    }
}

// A cube that cannot be read back leaves a hole into which nothing may be fused; the rest of the scan goes on.
void PagingStage::Put(const StoredCube& cube, MappingStage& mapping, ScanStage& scan) {
    const auto expected = away_.extract(cube.key);
    if (cube.status.ok() && expected.mapped() == static_cast<std::int32_t>(cube.blocks.size())) {
        mapping.Return(cube.blocks, ids_);
        scan.Returned(mapping.map(), ids_);
        return;
    }
    lost_.push_back(cube.key);
    if (std::exchange(told_lost_, true)) return;
    const Status status = cube.status.ok() ? DamagedScan(scan.path(), "blocks that left memory are missing") : cube.status;
    message_ = status.message() + "; frames that see this part of the map are tracked, but not fused";
}

// All cubes that may go, the farthest first.
std::vector<PagingStage::Candidate> PagingStage::Farthest(const BlockMap& map) {
    resident_.clear();
    for (BlockId id = 1; id < map.size(); ++id)
        if (!map.IsFree(id)) resident_.emplace_back(CubeOf(map.coord(id)), id);
    std::ranges::sort(resident_);
    std::vector<Candidate> candidates;
    for (std::size_t first = 0, last = 0; first < resident_.size(); first = last) {
        const BlockCoord cube = resident_[first].first;
        while (last < resident_.size() && resident_[last].first == cube) ++last;
        const double outside_m = Outside(cube);
        if (outside_m > kKeep_m) candidates.push_back({outside_m, cube, first, last});
    }
    std::ranges::stable_sort(candidates, std::greater(), &Candidate::outside_m);
    return candidates;
}

bool PagingStage::AllSaved(const Candidate& candidate, const BlockMap& map, const ScanStage& scan) const {
    return std::all_of(resident_.begin() + static_cast<std::ptrdiff_t>(candidate.first),
                       resident_.begin() + static_cast<std::ptrdiff_t>(candidate.last),
                       [&](const auto& block) { return scan.Has(map, block.second); });
}

// As many as are to go, of those that may; says so if they are too few.
std::vector<PagingStage::Candidate> PagingStage::ChooseLeaving(const BlockMap& map, const ScanStage& scan) {
    const auto bytes = static_cast<double>(map.bytes());
    const double block_bytes = bytes / static_cast<double>(map.count() + 1);
    double rest_bytes = bytes, least_bytes = bytes;  // with those that leave gone, and with all that may
    std::vector<Candidate> leaving;
    for (const Candidate& candidate : Farthest(map)) {
        const double candidate_bytes = block_bytes * static_cast<double>(candidate.last - candidate.first);
        least_bytes -= candidate_bytes;
        if (rest_bytes <= kRefill * limit_bytes_ || (!wait_ && !AllSaved(candidate, map, scan))) continue;
        rest_bytes -= candidate_bytes;
        leaving.push_back(candidate);
    }
    if (least_bytes > limit_bytes_ && !std::exchange(told_small_, true))
        message_ = fmt::format("mapping.memory_limit_mb: {:.0f} MB are too few for what the camera may see from one place, {:.0f} MB; "
                               "raise it, or lower frame.max_depth_m",
                               limit_bytes_ / 1e6, least_bytes / 1e6);
    return leaving;
}

void PagingStage::Release(MappingStage& mapping, ScanStage& scan) {
    const BlockMap& map = mapping.map();
    if (static_cast<double>(map.bytes()) <= limit_bytes_ || !T_world_camera_) return;
    if ((!wait_ && !scan.idle()) || scan.failed()) return;  // in this order: a checkpoint that failed is no longer under way
    const std::vector<Candidate> leaving = ChooseLeaving(map, scan);
    if (leaving.empty()) return;
    if (wait_) {
        const bool saved = std::ranges::all_of(leaving, [&](const Candidate& c) { return AllSaved(c, map, scan); });
        if (!scan.Settle(mapping, !saved)) return;
    }
    paged_ = true;
    for (const Candidate& c : leaving) {
        ids_.clear();
        for (std::size_t i = c.first; i < c.last; ++i) ids_.push_back(resident_[i].second);
        mapping.Release(ids_);
        scan.Released(ids_);
        away_[CubeKey(c.cube)] = static_cast<std::int32_t>(ids_.size());
    }
}

Status PagingStage::ReturnAll(MappingStage& mapping, ScanStage& scan) {
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
    return lost_.empty() ? Status::Ok() : DamagedScan(scan.path(), "blocks that left memory cannot be read back");
}

std::string PagingStage::Lacking(const ScanStage& scan) const {
    if (away_.empty() && lost_.empty()) return {};
    return fmt::format("; without what is in {} only: `tessera export` has all", scan.path());
}

void PagingStage::Reset() {
    while (pager_ && pager_->under_way() > 0) pager_->Give(pager_->Take());
    away_.clear();
    asked_.clear();
    wanted_.clear();
    lost_.clear();
    paged_ = false;
    step_m_ = 0;
    T_world_camera_.reset();
}

}  // namespace tessera
