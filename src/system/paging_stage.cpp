#include "system/paging_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tessera {
namespace {

constexpr double kAhead_m = 1.0;   // so much before the camera may see a cube it is asked for
constexpr double kKeep_m = 1.25;   // and so far beyond that it may go: else it would come and go
constexpr double kRefill = 0.9;    // of the limit, that a release goes down to
constexpr std::int64_t kFrames = 8;  // after which a cube that was asked for is put in, lockstep
constexpr std::size_t kMostPerFrame = 8;  // cubes that live puts in

// How far from the camera fusion and tracking may read.
double ReachOf(const PipelineConfig& config, const PinholeCamera& camera) {
    constexpr double kMargin_m = 0.3;  // tracking tries poses around the one that it finds
    double corner_m = 0;
    for (const double u : {-0.5, camera.width - 0.5})
        for (const double v : {-0.5, camera.height - 0.5})
            corner_m = std::max(corner_m, camera.Unproject(u, v, config.frame.max_depth_m).norm());
    return corner_m + config.map.truncation_m + 2 * kBlockSide * config.map.voxel_size_m + kMargin_m;
}

}  // namespace

void PagingConfig::Describe(ConfigParameters& p) {
    p.Add("memory_limit_mb", memory_limit_mb, {0.0, 1e6}, "MB",
          "most memory of the map's blocks, 0 = no limit: what is far from the camera goes to the file of --scan and comes back "
          "before it is seen; what the camera may see from one place must fit");
}

PagingStage::PagingStage(const PipelineConfig& config, const PinholeCamera& camera, std::unique_ptr<Pager> pager, bool wait)
    : limit_bytes_(config.paging.memory_limit_mb * 1e6),
      cube_m_(kCubeBlocks * kBlockSide * config.map.voxel_size_m),
      reach_m_(ReachOf(config, camera)),
      wait_(wait),
      pager_(std::move(pager)) {}

Status StartPaging(const PipelineConfig& config, const PinholeCamera& camera, const std::string& scan_path, bool wait,
                   std::unique_ptr<PagingStage>& paging) {
    if (!config.paging.enabled()) return Status::Ok();
    Result<std::unique_ptr<CubeReader>> reader = CubeReader::Open(scan_path);
    if (!reader.ok()) return reader.status();
    paging = std::make_unique<PagingStage>(config, camera, std::make_unique<Pager>(std::move(reader.value())), wait);
    return Status::Ok();
}

// How far a cube is from the half ball that the camera may read; at most 0: it is in it.
double PagingStage::Outside(const BlockCoord& cube) const {
    const Eigen::Vector3d camera = T_world_camera_->translation();
    const Eigen::Vector3d low = Eigen::Vector3d(cube.x, cube.y, cube.z) * cube_m_;
    const Eigen::Vector3d high = low.array() + cube_m_;
    const double away_m = (camera - camera.cwiseMax(low).cwiseMin(high)).norm();
    const double ahead_m = T_world_camera_->linear().col(2).dot(0.5 * (low + high) - camera) + 0.866 * cube_m_;
    return std::max(away_m - reach_m_, -ahead_m - 0.3);
}

// What is near and away, whether asked for or not.
void PagingStage::Plan() {
    wanted_.clear();
    for (Asked& asked : asked_) asked.outside_m = Outside(CubeOfKey(asked.key));
    if (away_.size() == asked_.size()) return;
    const Eigen::Array3d camera = T_world_camera_->translation();
    const Eigen::Array3i first = ((camera - reach_m_ - kAhead_m) / cube_m_).floor().cast<int>();
    const Eigen::Array3i last = ((camera + reach_m_ + kAhead_m) / cube_m_).floor().cast<int>();
    for (int z = first.z(); z <= last.z(); ++z)
        for (int y = first.y(); y <= last.y(); ++y)
            for (int x = first.x(); x <= last.x(); ++x) {
                const double outside_m = Outside({x, y, z});
                if (outside_m > kAhead_m) continue;
                const std::int64_t key = CubeKey({x, y, z});
                if (!away_.contains(key) || std::ranges::find(asked_, key, &Asked::key) != asked_.end()) continue;
                wanted_.push_back({key, outside_m, 0});
            }
    std::ranges::sort(wanted_, {}, [](const Asked& a) { return std::pair(a.outside_m, a.key); });
}

void PagingStage::Ask() {
    while (!wanted_.empty() && pager_->under_way() < Pager::kMostAsked) {
        wanted_.front().frame = frame_;
        pager_->Ask(wanted_.front().key);
        asked_.push_back(wanted_.front());
        wanted_.pop_front();
    }
}

bool PagingStage::NeedsOneOf(const std::deque<Asked>& cubes) const {
    return std::ranges::any_of(cubes, [](const Asked& asked) { return asked.outside_m <= 0; });
}

void PagingStage::BeginFrame(MappingStage& mapping, ScanStage& scan) {
    ++frame_;
    if (T_world_camera_) Bring(*T_world_camera_, mapping, scan);
}

bool PagingStage::Bring(const Eigen::Isometry3d& T_world_camera, MappingStage& mapping, ScanStage& scan) {
    T_world_camera_ = T_world_camera;
    if (away_.empty() || !status_.ok()) return status_.ok();
    Plan();
    Ask();
    TakeWhatCame(mapping, scan);
    return status_.ok() && !NeedsOneOf(asked_) && !NeedsOneOf(wanted_);
}

void PagingStage::TakeWhatCame(MappingStage& mapping, ScanStage& scan) {
    for (std::size_t taken = 0; !asked_.empty() && (wait_ || taken < kMostPerFrame); ++taken) {
        const bool needed = NeedsOneOf(asked_) || NeedsOneOf(wanted_);
        if (wait_ && !needed && frame_ - asked_.front().frame < kFrames) return;
        std::unique_ptr<StoredCube> cube = wait_ ? pager_->Take() : pager_->TryTake();
        if (!cube) return;
        asked_.pop_front();
        Put(*cube, mapping, scan);
        pager_->Give(std::move(cube));
        Ask();
    }
}

void PagingStage::Put(const StoredCube& cube, MappingStage& mapping, ScanStage& scan) {
    const auto expected = away_.extract(cube.key);
    if (!cube.status.ok())
        status_ = cube.status;
    else if (expected.mapped() != static_cast<std::int32_t>(cube.blocks.size()))
        status_ = Status::Error(fmt::format("{}: {} of {} blocks that left memory are there; the scan is damaged", scan.path(),
                                            cube.blocks.size(), expected.mapped()));
    if (!status_.ok()) return;
    mapping.Return(cube.blocks, ids_);
    scan.Returned(mapping.map(), ids_);
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

void PagingStage::Release(MappingStage& mapping, ScanStage& scan) {
    const BlockMap& map = mapping.map();
    const auto bytes = static_cast<double>(map.bytes());
    if (bytes <= limit_bytes_ || !T_world_camera_ || scan.failed() || (!wait_ && !scan.idle())) return;
    const double block_bytes = bytes / static_cast<double>(map.count() + 1);
    double excess_bytes = bytes - kRefill * limit_bytes_;
    std::vector<Candidate> leaving;
    for (const Candidate& candidate : Farthest(map)) {
        if (excess_bytes <= 0) break;
        if (!wait_ && !AllSaved(candidate, map, scan)) continue;
        excess_bytes -= block_bytes * static_cast<double>(candidate.last - candidate.first);
        leaving.push_back(candidate);
    }
    if (wait_ && excess_bytes > (1 - kRefill) * limit_bytes_ && !std::exchange(told_, true))
        message_ = fmt::format("mapping.memory_limit_mb: {:.0f} MB are too few for what the camera may see from one place, {:.0f} MB; "
                               "raise it, or lower frame.max_depth_m",
                               limit_bytes_ / 1e6, (excess_bytes + kRefill * limit_bytes_) / 1e6);
    if (leaving.empty()) return;
    if (wait_) {
        const bool saved = std::ranges::all_of(leaving, [&](const Candidate& c) { return AllSaved(c, map, scan); });
        if (!scan.Settle(mapping, !saved)) return;
    }
    for (const Candidate& c : leaving) {
        ids_.clear();
        for (std::size_t i = c.first; i < c.last; ++i) ids_.push_back(resident_[i].second);
        mapping.Release(ids_);
        scan.Released(ids_);
        away_[CubeKey(c.cube)] = static_cast<std::int32_t>(ids_.size());
    }
}

void PagingStage::Reset() {
    while (pager_ && pager_->under_way() > 0) pager_->Give(pager_->Take());
    away_.clear();
    asked_.clear();
    wanted_.clear();
    T_world_camera_.reset();
}

}  // namespace tessera
