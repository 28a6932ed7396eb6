#include "tracking/moving_evidence.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/se3.h"
#include "tracking/tile_regions.h"

namespace tessera {
namespace {

using Marks = Image<std::uint8_t>;
constexpr double kAges[] = {0.3, 1.0};  // of the frames to compare with, in windows
constexpr double kOld = 0.8;            // in windows; what stood there this long ago stands still
// Approximate time over which an image is spread: blur, rolling shutter, timestamp errors.
constexpr double kImageTime_s = 0.015;
constexpr double kBody_m = 0.6;              // maximum reach of a connected body
constexpr int kBeside = 4, kBesideHint = 1;  // tiles

void Join(const Marks& more, Marks& marks) {
    for (std::size_t i = 0; i < marks.size(); ++i) marks.data()[i] |= more.data()[i];
}

// Blurs the edges of `view` by this many more tiles, as many as those of the view it is compared
// with.
const TileView& Blurred(const TileView& view, int more, TileView& storage) {
    if (more == 0) return view;
    storage = view;
    storage.blur += more;
    NearestInWindow(storage.depth_m, 1 + storage.blur, storage.near_m);
    return storage;
}

}  // namespace

// A detector's hint as seen by a camera at this pose. Empty if there was none within the window, or
// if its frame, which is another, was not tracked.
DepthImage MovingHistory::CarriedHint(double stamp_s, const Eigen::Isometry3d& T_world_camera,
                                      const PinholeCamera& camera, double window_s) const {
    if (hint.depth_m.empty() || std::abs(stamp_s - hint.stamp_s) > window_s) return {};
    if (stamp_s == hint.stamp_s) return hint.depth_m;
    if (!hint_placed) return {};
    DepthImage carried_m(camera.width, camera.height);
    ReprojectMarks(hint, Marks(camera.width, camera.height, 1), T_world_camera, camera, carried_m);
    return carried_m;
}

int MovingAnalysis::Blur(double turned_rad, double since_s) const {
    return std::min(6, static_cast<int>(turned_rad / since_s * kImageTime_s * camera_.fx + 0.5));
}

void MovingAnalysis::Ingest(const MovingDetector::Input& input, int step, const BlockMap& map) {
    MovingHistory& m = memory_;
    const double since_s = input.stamp_s - m.now.stamp_s;
    const bool follows = !m.now.depth_m.empty() && since_s > 0 && since_s < config_.window_s;
    if (!follows) {
        m.past.clear();
        m.moving = {};
        m.intervals = 0;
        m.intervals_s = 0;
    } else {
        ++m.intervals;
        m.intervals_s += since_s;
    }
    m.now.blur =
        follows ? Blur(RotationAngle(m.now.T_world_camera, input.T_world_camera), since_s) : 0;
    m.now.T_world_camera = input.T_world_camera;
    m.now.stamp_s = input.stamp_s;
    m.now.map_end = map.size();
    MakeTiles(input.depth_m, step, input.disparity_offset_per_m, m.now.depth_m);
    NearestInWindow(m.now.depth_m, 1 + m.now.blur, m.now.near_m);
    while (!m.past.empty() && m.past.front().stamp_s < input.stamp_s - 1.1 * config_.window_s)
        m.past.pop_front();
}

std::vector<const TileView*> MovingAnalysis::ToCompare() const {
    std::vector<const TileView*> moments;
    for (const double age : kAges) {
        const TileView* found = nullptr;  // the newest that is old enough, or the oldest
        for (const TileView& view : memory_.past)
            if (found == nullptr ||
                view.stamp_s <= memory_.now.stamp_s - age * config_.window_s + 1e-4)
                found = &view;
        if (found != nullptr && (moments.empty() || moments.back() != found))
            moments.push_back(found);
    }
    return moments;
}

bool MovingAnalysis::IsOld(const TileView& view) const {
    return memory_.now.stamp_s - view.stamp_s >= kOld * config_.window_s;
}

// Whether the map had a block at the tile's point one window ago.
bool MovingAnalysis::MapHadIt(int x, int y, const BlockMap& map) const {
    const TileView& now = memory_.now;
    if (memory_.past.empty() || !IsOld(memory_.past.front())) return false;
    const double block_m = map.config().voxel_size_m * kBlockSide;
    const Eigen::Vector3i block =
        (now.T_world_camera * camera_.Unproject(x, y, now.depth_m(x, y)) / block_m)
            .array()
            .floor()
            .cast<int>();
    const BlockId id = map.Find({block.x(), block.y(), block.z()});
    return id != kUnknownBlock && id < memory_.past.front().map_end;
}

DepthChanges MovingAnalysis::Compare() const {
    const TileView& now = memory_.now;
    const std::vector<const TileView*> moments = ToCompare();
    std::array<DepthChanges, std::size(kAges)> parts;
    tbb::parallel_for(std::size_t{0}, 2 * moments.size(), [&](std::size_t i) {
        DepthChanges& part = parts[i / 2];
        const TileView& past = *moments[i / 2];
        TileView storage;
        if (i % 2 == 0) {
            part.came = Marks(camera_.width, camera_.height);
            MarkFree(now, Blurred(past, now.blur, storage), camera_, margin_, part.came);
        } else {
            part.left_m = DepthImage(camera_.width, camera_.height);
            FindDeparted(past, Blurred(now, past.blur, storage), camera_, margin_, part.left_m);
        }
    });
    DepthChanges changes;
    changes.came = changes.there = Marks(camera_.width, camera_.height);
    changes.left_m = DepthImage(camera_.width, camera_.height);
    Marks left = changes.came;
    for (std::size_t i = 0; i < moments.size(); ++i) {
        Join(parts[i].came, changes.came);
        for (std::size_t at = 0; at < left.size(); ++at) {
            const float left_m = parts[i].left_m.data()[at];
            if (left_m <= 0) continue;
            left.data()[at] = 1;
            changes.left_m.data()[at] = left_m;  // the oldest frame's value
        }
    }
    changes.any = HasCore(changes.came) || HasCore(left);
    if (!moments.empty() && IsOld(*moments.back()) && changes.any)
        MarkSame(now, *moments.back(), camera_, margin_, changes.there);
    // Noise disappears in specks, an object as a region.
    KeepRegions(changes.left_m, left, camera_, {config_.min_area_m2, 0}, left);
    for (std::size_t at = 0; at < left.size(); ++at)
        if (left.data()[at] == 0) changes.left_m.data()[at] = 0;
    return changes;
}

MovingEvidence MovingAnalysis::Evaluate(const DepthChanges& changes, const DepthImage& hinted_m,
                                        const BlockMap& map, const DepthImage& predicted_m) const {
    const int width = camera_.width, height = camera_.height;
    const TileView& now = memory_.now;
    DepthImage nearest_m, farthest_m;
    NearestInWindow(predicted_m, 1, nearest_m);
    FarthestInWindow(predicted_m, 1, farthest_m);
    const int last_x = predicted_m.width() - 1, last_y = predicted_m.height() - 1;
    MovingEvidence e;
    e.seeds = changes.came;
    MarkNear(now.depth_m, changes.left_m, kBeside, e.seeds);
    MarkNear(now.depth_m, hinted_m, kBesideHint, e.seeds);
    e.candidates = e.seeds;
    e.growing = e.gone = Marks(width, height);
    std::int64_t known = 0, fitting = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int u = std::min(x / kMapQueryStride, last_x),
                      v = std::min(y / kMapQueryStride, last_y);
            const float depth = now.depth_m(x, y), mapped = predicted_m(u, v);
            if (depth <= 0) continue;
            const float off = margin_(std::max(depth, mapped)), nearest = nearest_m(u, v),
                        farthest = farthest_m(u, v);
            const bool fits = mapped > 0 && nearest - off <= depth && depth <= farthest + off;
            // Neither the view nor the map of one window ago has it.
            e.growing(x, y) = changes.there(x, y) == 0 && !(fits && MapHadIt(x, y, map));
            if (mapped <= 0) continue;
            const bool left = changes.left_m(x, y) > 0, before = depth + off < nearest;
            if (before) e.candidates(x, y) = 1;
            if (before && left) e.seeds(x, y) = 1;
            // near_m tolerates edges that are a little off.
            e.gone(x, y) = mapped + off < now.near_m(x, y);
            if (e.candidates(x, y) != 0 || left) continue;
            ++known;
            fitting += fits;
        }
    // If the rest does not fit the map either, the camera pose is wrong.
    e.fits =
        static_cast<double>(fitting) >= config_.min_fitting_fraction * static_cast<double>(known);
    return e;
}

void MovingAnalysis::Decide(MovingEvidence& e) {
    const DepthImage& depth_m = memory_.now.depth_m;
    KeepRegions(depth_m, e.seeds, camera_, {config_.min_area_m2, config_.min_changed_fraction},
                e.candidates);
    GrowRegions(depth_m, e.growing, camera_, kBody_m, e.candidates);
    memory_.moving = e.candidates;
}

}  // namespace tessera
