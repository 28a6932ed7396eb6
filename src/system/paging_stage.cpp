#include "system/paging_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/check.h"
#include "scan/scan_file.h"

namespace tessera {
namespace {

constexpr double kAhead_m = 1.0;  // a cube is requested this far before the camera may see it
// Lockstep: a requested cube is inserted after this many frames.
constexpr std::int64_t kFrames = 8;
constexpr std::size_t kMostPerFrame = 8;  // live: maximum number of cubes inserted

}  // namespace

PagingStage::PagingStage(const PipelineConfig& config, const PinholeCamera& camera,
                         std::unique_ptr<CubeReader> reader, bool wait, MappingStage& mapping,
                         ScanStage& scan, Notices& notices)
    : limit_bytes_(config.memory_limit_mb * 1e6),
      viewed_(config, camera),
      wait_(wait),
      mapping_(mapping),
      scan_(scan),
      notices_(notices),
      reader_(std::move(reader)),
      reading_(kMostAsked, [this](std::int64_t& key) { Read(key); }) {}

double PagingStage::Outside(const BlockCoord& cube) const {
    return viewed_.Outside_m(*T_world_camera_, cube);
}

// Collects the paged-out cubes that are near and not yet requested.
void PagingStage::Plan() {
    wanted_.clear();
    for (Asked& asked : asked_) asked.outside_m = Outside(CubeOfKey(asked.key));
    if (away_.size() == asked_.size()) return;
    const auto [first, last] = viewed_.Around(*T_world_camera_, kAhead_m);
    const double count =
        (last.x - first.x + 1.0) * (last.y - first.y + 1.0) * (last.z - first.z + 1.0);
    const bool here_only = !expected_ || frame_ > expected_->until;
    if (here_only && count < static_cast<double>(away_.size())) {
        for (int z = first.z; z <= last.z; ++z)
            for (int y = first.y; y <= last.y; ++y)
                for (int x = first.x; x <= last.x; ++x) Want({x, y, z});
    } else {
        for (const auto& [key, blocks] : away_) Want(CubeOfKey(key));
    }
    std::ranges::sort(wanted_, {}, [](const Asked& a) { return std::pair(a.outside_m, a.key); });
}

bool PagingStage::IsExpected(const BlockCoord& cube) const {
    return expected_ && frame_ <= expected_->until &&
           viewed_.Outside_m(expected_->T_world_camera, cube) <= 0;
}

void PagingStage::Want(const BlockCoord& cube) {
    const double outside_m = Outside(cube);
    if (outside_m > kAhead_m && !IsExpected(cube)) return;
    const std::int64_t key = CubeKey(cube);
    if (!away_.contains(key) || std::ranges::find(asked_, key, &Asked::key) != asked_.end()) return;
    wanted_.push_back({key, outside_m, 0});
}

void PagingStage::Ask() {
    while (!wanted_.empty() && asked_.size() < kMostAsked) {
        Asked& cube = wanted_.front();
        cube.frame = frame_;
        TESSERA_CHECK(reading_.TryPush(std::int64_t{cube.key}), "no room for cube {}", cube.key);
        asked_.push_back(cube);
        wanted_.pop_front();
    }
}

// On the thread that reads.
void PagingStage::Read(std::int64_t key) {
    std::unique_ptr<StoredCube> cube = pool_.Take();
    cube->key = key;
    cube->status = reader_->Read(key, cube->blocks);
    TESSERA_CHECK(read_.TryPush(std::move(cube)), "no room for cube {}", key);
}

// The next requested cube. Null if it has not been read yet, unless it is to be waited for.
std::unique_ptr<PagingStage::StoredCube> PagingStage::TakeCube(bool wait) {
    std::unique_ptr<StoredCube> cube;
    if (wait)
        owner_.Wait([&] { return read_.TryPop(cube); });
    else
        read_.TryPop(cube);
    if (!cube) return nullptr;
    TESSERA_CHECK(cube->key == asked_.front().key, "cube {} comes before cube {}", cube->key,
                  asked_.front().key);
    asked_.pop_front();
    return cube;
}

// Whether a cube still to be loaded is in what the camera may see, or at most `further_m` outside.
bool PagingStage::Needs(double further_m) const {
    const auto needed = [&](const Asked& cube) { return cube.outside_m <= further_m; };
    return std::ranges::any_of(asked_, needed) || std::ranges::any_of(wanted_, needed);
}

// The next camera is assumed about as far from the last as that was from the one before: tracking
// starts there.
void PagingStage::BeginFrame() {
    ++frame_;
    if (T_world_camera_) Bring(std::min(step_m_, kAhead_m));
}

bool PagingStage::AfterTracking(TrackedFrame& tracked) {
    if (!tracked.report.tracked() && !tracked.to_fuse) return false;
    const Eigen::Isometry3d& T_world_camera = tracked.report.track.T_world_camera;
    if (T_world_camera_)
        step_m_ = (T_world_camera.translation() - T_world_camera_->translation()).norm();
    T_world_camera_ = T_world_camera;
    return !Bring(0) && std::exchange(tracked.to_fuse, false);
}

// Returns false if part of what the camera may see is missing.
bool PagingStage::Bring(double further_m) {
    if (!away_.empty()) {
        Plan();
        if (AwaitReplaced()) {
            Ask();
            InsertLoaded(further_m);
        }
    }
    return !Needs(0) && std::ranges::none_of(
                            lost_, [&](std::int64_t key) { return Outside(CubeOfKey(key)) <= 0; });
}

void PagingStage::InsertLoaded(double further_m) {
    for (std::size_t taken = 0; !asked_.empty() && (wait_ || taken < kMostPerFrame); ++taken) {
        if (wait_ && !Needs(further_m) && frame_ - asked_.front().frame < kFrames) return;
        std::unique_ptr<StoredCube> cube = TakeCube(wait_);
        if (!cube) return;
        Put(*cube);
        pool_.Give(std::move(cube));
        Ask();
    }
}

// A cube that cannot be read back leaves a hole into which nothing may be fused. The rest of the
// scan continues.
void PagingStage::Put(const StoredCube& cube) {
    const auto expected = away_.extract(cube.key);
    if (cube.status.ok() && expected.mapped() == static_cast<std::int32_t>(cube.blocks.size())) {
        mapping_.Return(cube.blocks, ids_);
        scan_.Returned(mapping_.map(), ids_);
        return;
    }
    lost_.push_back(cube.key);
    if (std::exchange(told_lost_, true)) return;
    const Status status =
        cube.status.ok()
            ? DamagedScan(scan_.path(), "blocks that were moved out of memory are missing")
            : cube.status;
    notices_.Tell(status.message() +
                  "; frames that see this part of the map are tracked but not fused");
}

void PagingStage::Replaced(const Eigen::Isometry3d& T_new_old, const RebuildPaging& pager) {
    Drain();
    away_ = pager.away();
    paged_ = pager.paged();
    if (T_world_camera_) T_world_camera_ = T_new_old * *T_world_camera_;
    for (Held& held : held_) held.T_world_camera = T_new_old * held.T_world_camera;
    expected_.reset();
    store_ = pager.store();
    scan_.Replaced(mapping_.map(), store_);
}

// Whether paged-out cubes can be read from the file. In lockstep, waits until they can.
bool PagingStage::AwaitReplaced() {
    if (!store_) return true;
    if (!scan_.HasReplaced() && !scan_.failed() && wait_) scan_.Settle(mapping_, true);
    if (scan_.failed()) {
        PutBackFromStore();
        Plan();
    } else if (!scan_.HasReplaced()) {
        return false;
    }
    store_.reset();
    return true;
}

// The file will never hold the new map, so everything is loaded back from the store.
void PagingStage::PutBackFromStore() {
    PutBack(store_->Cubes(),
            [this](std::int64_t key, BlockCopies& blocks) { return store_->Read(key, blocks); });
    store_.reset();
}

// Of these cubes, those that are paged out.
void PagingStage::PutBack(const CubeCounts& cubes, const ReadCube& read) {
    StoredCube cube;
    for (const auto& [key, blocks] : cubes) {
        if (!away_.contains(key)) continue;
        cube.key = key;
        cube.status = read(key, cube.blocks);
        Put(cube);
    }
}

void PagingStage::LoadAround(const Eigen::Isometry3d& T_world_camera) {
    const auto here = std::exchange(T_world_camera_, T_world_camera);
    Bring(0);
    T_world_camera_ = here;
}

void PagingStage::Drain() {
    while (reader_ && !asked_.empty()) pool_.Give(TakeCube(true));
    away_.clear();
    asked_.clear();
    wanted_.clear();
    lost_.clear();
}

void PagingStage::Reset() {
    Drain();
    store_.reset();
    expected_.reset();
    held_.clear();
    paged_ = false;
    step_m_ = 0;
    T_world_camera_.reset();
}

}  // namespace tessera
