#include "tracking/moving_detector.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/se3.h"
#include "tracking/tile_regions.h"

namespace tessera {
namespace {

using Marks = Image<std::uint8_t>;
constexpr int kTileColumns = 128;      // about so many
constexpr int kAges = 2;               // moments that a frame is compared with
constexpr double kShares[kAges] = {0.3, 1.0};  // their ages, of the window
constexpr double kSpacing = 0.1;       // of remembered moments, of the window
constexpr double kImageTime_s = 0.015; // an image is spread over about so much: blur, rolling shutter, stamps
constexpr double kBody_m = 0.6;        // what hangs together reaches so far
constexpr int kAround = 2, kExpectedAround = 3;  // tiles

void Join(const Marks& more, Marks& marks) {
    std::transform(more.data(), more.data() + more.size(), marks.data(), marks.data(),
                   [](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>(a | b); });
}

std::int64_t CountOf(const Marks& marks) { return std::count_if(marks.data(), marks.data() + marks.size(), [](auto m) { return m != 0; }); }

}  // namespace

// Tiles of the frame: where something has come, and where something was.
struct MovingDetector::Changes {
    Marks came, left;
    Marks there;  // where a surface was seen a while ago, too
};

MovingDetector::MovingDetector(const Config& config, const PinholeCamera& camera)
    : config_(config),
      margin_{static_cast<float>(config.margin_m), static_cast<float>(config.margin_per_m)},
      step_(std::max(1, static_cast<int>(std::lround(static_cast<double>(camera.width) / kTileColumns)))),
      camera_(camera.Every(step_)) {}

// Tiles that an edge may have shifted by while the image was taken.
int MovingDetector::ReachOf(const Input& input) const {
    if (past_.empty()) return 1;
    const double since_s = std::max(input.stamp_s - past_.back().stamp_s, 1e-3);
    const double turned = RotationAngle(past_.back().T_world_camera, input.T_world_camera);
    return 1 + std::min(6, static_cast<int>(turned / since_s * kImageTime_s * camera_.fx + 0.5));
}

std::shared_ptr<const MovingMask> MovingDetector::Find(const Input& input, const BlockMap& map, ViewPredictor& predictor) {
    if (!past_.empty() && input.stamp_s <= past_.back().stamp_s) past_.clear();
    while (!past_.empty() && past_.front().stamp_s < input.stamp_s - 1.1 * config_.window_s) past_.pop_front();
    now_.T_world_camera = input.T_world_camera;
    now_.stamp_s = input.stamp_s;
    MakeTiles(input.depth_m, step_, input.disparity_offset_per_m, now_.depth_m);
    NearestAround(now_.depth_m, ReachOf(input), now_.near_m);
    Changes changes;
    const bool changed = FindChanges(changes);
    Remember();
    found_.reset();
    if (!changed) return nullptr;
    constexpr float kNearest_m = 0.1f;
    predictor.Predict(map, camera_, input.T_world_camera, kNearest_m, 1.2f * input.farthest_m, predicted_);
    return found_ = Judge(changes, predicted_.depth_m);
}

void MovingDetector::Remember() {
    if (past_.empty() || now_.stamp_s - past_.back().stamp_s >= kSpacing * config_.window_s) past_.push_back(now_);
}

std::vector<const TileView*> MovingDetector::Moments() const {
    std::vector<const TileView*> moments;
    for (const double share : kShares) {
        const TileView* found = nullptr;  // the youngest that is old enough, or the oldest
        for (const TileView& view : past_)
            if (found == nullptr || view.stamp_s <= now_.stamp_s - share * config_.window_s + 1e-4) found = &view;
        if (found != nullptr && (moments.empty() || moments.back() != found)) moments.push_back(found);
    }
    return moments;
}

bool MovingDetector::FindChanges(Changes& changes) const {
    const std::vector<const TileView*> moments = Moments();
    std::array<Changes, kAges> parts;
    tbb::parallel_for(std::size_t{0}, moments.size(), [&](std::size_t i) {
        Changes& part = parts[i];
        part.came = part.left = Marks(camera_.width, camera_.height);
        MarkFree(now_, *moments[i], camera_, margin_, &part.came, nullptr);
        MarkFree(*moments[i], now_, camera_, margin_, nullptr, &part.left);
    });
    changes.came = changes.left = Marks(camera_.width, camera_.height);
    for (std::size_t i = 0; i < moments.size(); ++i) {
        Join(parts[i].came, changes.came);
        Join(parts[i].left, changes.left);
    }
    if (!HasCore(changes.came) && !HasCore(changes.left)) return false;
    changes.there = Marks(camera_.width, camera_.height);
    MarkSame(now_, *moments.back(), camera_, margin_, changes.there);
    return true;
}

std::shared_ptr<const MovingMask> MovingDetector::Judge(const Changes& changes, const DepthImage& predicted_m) const {
    const int width = camera_.width, height = camera_.height;
    DepthImage nearest_m, farthest_m;
    NearestAround(predicted_m, 1, nearest_m);
    FarthestAround(predicted_m, 1, farthest_m);
    auto mask = std::make_shared<MovingMask>();
    mask->step = step_;
    mask->moving = changes.came;
    Marks seeds = changes.came, growing(width, height), gone(width, height);
    std::int64_t known = 0, fitting = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float depth = now_.depth_m(x, y), map = predicted_m(x, y);
            if (depth <= 0) continue;
            const bool before = map > 0 && depth + margin_(map) < nearest_m(x, y);
            if (before) mask->moving(x, y) = 1;
            if (before && changes.left(x, y) != 0) seeds(x, y) = 1;
            growing(x, y) = changes.there(x, y) == 0;
            gone(x, y) = map > 0 && farthest_m(x, y) + margin_(depth) < now_.near_m(x, y);
            if (map <= 0 || mask->moving(x, y) != 0 || changes.left(x, y) != 0) continue;
            ++known;
            fitting += std::abs(depth - map) <= margin_(depth) || (nearest_m(x, y) - margin_(depth) <= depth && depth <= farthest_m(x, y) + margin_(depth));
        }
    // Where the rest does not fit the map either, it is the camera that is elsewhere.
    if (static_cast<double>(fitting) < config_.min_fitting_fraction * static_cast<double>(known)) return nullptr;
    const RegionRule rule{config_.min_area_m2, config_.min_changed_fraction};
    KeepRegions(now_.depth_m, seeds, camera_, rule, mask->moving);
    GrowRegions(now_.depth_m, growing, camera_, kBody_m, mask->moving);
    KeepRegions(now_.depth_m, changes.left, camera_, rule, gone);
    mask->moving_tiles = CountOf(mask->moving);
    mask->gone_tiles = CountOf(gone);
    if (mask->moving_tiles + mask->gone_tiles == 0) return nullptr;
    Dilate(kAround, mask->moving);
    Dilate(kAround, gone);
    mask->moving_tiles = CountOf(mask->moving);
    mask->gone_m.Resize(width, height);
    for (std::size_t i = 0; i < gone.size(); ++i) mask->gone_m.data()[i] = gone.data()[i] != 0 ? now_.near_m.data()[i] : 0.0f;
    return mask;
}

std::shared_ptr<const MovingMask> MovingDetector::Expect(double stamp_s, const Eigen::Isometry3d& T_world_camera) const {
    constexpr double kLongest_s = 0.2;  // between two frames
    if (!found_ || found_->moving_tiles == 0 || std::abs(stamp_s - now_.stamp_s) > kLongest_s) return nullptr;
    auto mask = std::make_shared<MovingMask>();
    mask->step = step_;
    mask->moving = Marks(camera_.width, camera_.height);
    MarkMoved(now_, found_->moving, T_world_camera, camera_, mask->moving);
    Dilate(kExpectedAround, mask->moving);
    mask->moving_tiles = CountOf(mask->moving);
    return mask;
}

void MovingDetector::Move(const Eigen::Isometry3d& T_new_old) {
    for (TileView& view : past_) view.T_world_camera = T_new_old * view.T_world_camera;
    now_.T_world_camera = T_new_old * now_.T_world_camera;
}

void MovingDetector::Config::Describe(ConfigParameters& p) {
    p.Add("enabled", enabled, "people and other moving things are neither tracked on nor fused (docs/moving.md)");
    p.Add("window_s", window_s, {0.1, 10.0}, "s",
          "what has stood still for so long belongs to the scene: shorter takes a moved chair in sooner, longer bears slower movers");
    p.Add("margin_m", margin_m, {0.005, 1.0}, "m",
          "depths nearer to each other than this plus margin_per_m times the squared depth are the same: the sensor's noise and "
          "the pose's");
    p.Add("margin_per_m", margin_per_m, {0.0, 0.1}, "1/m", "see margin_m; 0.01 is three times a structured-light sensor's noise");
    p.Add("min_area_m2", min_area_m2, {0.0, 10.0}, "m^2", "smaller regions do not count");
    p.Add("min_changed_fraction", min_changed_fraction, {0.01, 1.0}, "",
          "share of a region that must have changed within window_s for it to count as moving");
    p.Add("min_fitting_fraction", min_fitting_fraction, {0.0, 1.0}, "",
          "nothing is taken for moving unless such a share of the rest fits the map: else the pose is wrong");
}

}  // namespace tessera
