#include "tracking/moving_detector.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "core/se3.h"
#include "tracking/tile_regions.h"
#include "tracking/tile_view.h"

namespace tessera {
namespace {

using Marks = Image<std::uint8_t>;
constexpr int kTileColumns = 128;      // about so many
constexpr double kAges[] = {0.3, 1.0}; // of the moments that a frame is compared with, in windows
constexpr double kOld = 0.8;           // the same: what stood there so long ago stands still
constexpr double kSpacing = 0.1;       // the same: of remembered moments
constexpr double kImageTime_s = 0.015; // an image is spread over about so much: blur, rolling shutter, stamps
constexpr double kBody_m = 0.6;        // what hangs together reaches so far
constexpr float kNearest_m = 0.1f;
constexpr int kAround = 2, kExpectedAround = 3, kBeside = 4;  // tiles
constexpr int kAsked = 2;              // of so many tiles in a row or column the map is asked at one

bool Marked(std::uint8_t mark) { return mark != 0; }
std::int64_t CountOf(const Marks& marks) { return std::count_if(marks.data(), marks.data() + marks.size(), Marked); }

void Join(const Marks& more, Marks& marks) {
    for (std::size_t i = 0; i < marks.size(); ++i) marks.data()[i] |= more.data()[i];
}

// As if its edges had moved by so many tiles more: what it is compared with has edges that did.
const TileView& Blurred(const TileView& view, int more, TileView& storage) {
    if (more == 0) return view;
    storage = view;
    storage.blur += more;
    NearestAround(storage.depth_m, 1 + storage.blur, storage.near_m);
    return storage;
}

// What differs between a frame and the moments before.
struct Changes {
    Marks came;          // stands in what was free space
    DepthImage left_m;   // how far what left had been, where it had been
    Marks there;         // stands where a surface was seen a window ago
    bool any = false;
};

// What the frame and the map's view say about each tile.
struct Evidence {
    Marks candidates;  // may move
    Marks seeds;       // of them, those that changed
    Marks growing;     // hang together with what moves, if they touch it
    Marks gone;        // the map's surface is seen through
    bool fits = false; // the rest fits the map
};

}  // namespace

struct MovingDetector::Memory {
    TileView now;
    std::deque<TileView> past;           // oldest first
    Marks moving;                        // in `now`; empty: nothing
};

// One frame against what is remembered.
class MovingDetector::Moments {
  public:
    Moments(const Config& config, const PinholeCamera& camera, Memory& memory)
        : config_(config),
          camera_(camera),
          margin_{static_cast<float>(config.margin_m), static_cast<float>(config.margin_per_m)},
          memory_(memory) {}

    void Take(const Input& input, int step);
    Changes Compare() const;
    Evidence Weigh(const Changes& changes, const DepthImage& predicted_m) const;
    void Decide(Evidence& evidence);

  private:
    std::vector<const TileView*> ToCompare() const;
    int Blur(double turned_rad, double since_s) const;

    const Config& config_;
    const PinholeCamera& camera_;
    DepthMargin margin_;
    Memory& memory_;
};

int MovingDetector::Moments::Blur(double turned_rad, double since_s) const {
    return std::min(6, static_cast<int>(turned_rad / since_s * kImageTime_s * camera_.fx + 0.5));
}

void MovingDetector::Moments::Take(const Input& input, int step) {
    Memory& m = memory_;
    const double since_s = input.stamp_s - m.now.stamp_s;
    const bool follows = !m.now.depth_m.empty() && since_s > 0 && since_s < config_.window_s;
    if (!follows) {
        m.past.clear();
        m.moving = {};
    }
    m.now.blur = follows ? Blur(RotationAngle(m.now.T_world_camera, input.T_world_camera), since_s) : 0;
    m.now.T_world_camera = input.T_world_camera;
    m.now.stamp_s = input.stamp_s;
    MakeTiles(input.depth_m, step, input.disparity_offset_per_m, m.now.depth_m);
    NearestAround(m.now.depth_m, 1 + m.now.blur, m.now.near_m);
    while (!m.past.empty() && m.past.front().stamp_s < input.stamp_s - 1.1 * config_.window_s) m.past.pop_front();
}

std::vector<const TileView*> MovingDetector::Moments::ToCompare() const {
    std::vector<const TileView*> moments;
    for (const double age : kAges) {
        const TileView* found = nullptr;  // the youngest that is old enough, or the oldest
        for (const TileView& view : memory_.past)
            if (found == nullptr || view.stamp_s <= memory_.now.stamp_s - age * config_.window_s + 1e-4) found = &view;
        if (found != nullptr && (moments.empty() || moments.back() != found)) moments.push_back(found);
    }
    return moments;
}

Changes MovingDetector::Moments::Compare() const {
    const TileView& now = memory_.now;
    const std::vector<const TileView*> moments = ToCompare();
    std::array<Changes, std::size(kAges)> parts;
    tbb::parallel_for(std::size_t{0}, 2 * moments.size(), [&](std::size_t i) {
        Changes& part = parts[i / 2];
        const TileView& past = *moments[i / 2];
        TileView storage;
        if (i % 2 == 0) {
            part.came = Marks(camera_.width, camera_.height);
            MarkFree(now, Blurred(past, now.blur, storage), camera_, margin_, part.came);
        } else {
            part.left_m = DepthImage(camera_.width, camera_.height);
            FindLeft(past, Blurred(now, past.blur, storage), camera_, margin_, part.left_m);
        }
    });
    Changes changes;
    changes.came = changes.there = Marks(camera_.width, camera_.height);
    changes.left_m = DepthImage(camera_.width, camera_.height);
    Marks left = changes.came;
    for (std::size_t i = 0; i < moments.size(); ++i) {
        Join(parts[i].came, changes.came);
        for (std::size_t at = 0; at < left.size(); ++at) {
            const float left_m = parts[i].left_m.data()[at];
            if (left_m <= 0) continue;
            left.data()[at] = 1;
            changes.left_m.data()[at] = left_m;  // the oldest moment's
        }
    }
    changes.any = HasCore(changes.came) || HasCore(left);
    const bool old = !moments.empty() && now.stamp_s - moments.back()->stamp_s >= kOld * config_.window_s;
    if (old && changes.any) MarkSame(now, *moments.back(), camera_, margin_, changes.there);
    // Noise leaves in specks, a thing as a region.
    KeepRegions(changes.left_m, left, camera_, {config_.min_area_m2, 0}, left);
    for (std::size_t at = 0; at < left.size(); ++at)
        if (left.data()[at] == 0) changes.left_m.data()[at] = 0;
    return changes;
}

Evidence MovingDetector::Moments::Weigh(const Changes& changes, const DepthImage& predicted_m) const {
    const int width = camera_.width, height = camera_.height;
    const TileView& now = memory_.now;
    DepthImage nearest_m, farthest_m;
    NearestAround(predicted_m, 1, nearest_m);
    FarthestAround(predicted_m, 1, farthest_m);
    const int last_x = predicted_m.width() - 1, last_y = predicted_m.height() - 1;
    Evidence e;
    e.seeds = changes.came;
    MarkBeside(now.depth_m, changes.left_m, kBeside, e.seeds);
    e.candidates = e.seeds;
    e.growing = e.gone = Marks(width, height);
    std::int64_t known = 0, fitting = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int u = std::min(x / kAsked, last_x), v = std::min(y / kAsked, last_y);
            const float depth = now.depth_m(x, y), map = predicted_m(u, v);
            if (depth <= 0) continue;
            e.growing(x, y) = changes.there(x, y) == 0;
            if (map <= 0) continue;
            const float off = margin_(std::max(depth, map)), nearest = nearest_m(u, v), farthest = farthest_m(u, v);
            const bool left = changes.left_m(x, y) > 0, before = depth + off < nearest;
            if (before) e.candidates(x, y) = 1;
            if (before && left) e.seeds(x, y) = 1;
            e.gone(x, y) = map + off < now.near_m(x, y);  // near_m bears edges that are a little off
            if (e.candidates(x, y) != 0 || left) continue;
            ++known;
            fitting += nearest - off <= depth && depth <= farthest + off;
        }
    // Where the rest does not fit the map either, it is the camera that is elsewhere.
    e.fits = static_cast<double>(fitting) >= config_.min_fitting_fraction * static_cast<double>(known);
    return e;
}

void MovingDetector::Moments::Decide(Evidence& e) {
    const DepthImage& depth_m = memory_.now.depth_m;
    KeepRegions(depth_m, e.seeds, camera_, {config_.min_area_m2, config_.min_changed_fraction}, e.candidates);
    GrowRegions(depth_m, e.growing, camera_, kBody_m, e.candidates);
    memory_.moving = e.candidates;
}

MovingDetector::MovingDetector(const Config& config, const PinholeCamera& camera)
    : config_(config),
      step_(std::max(1, static_cast<int>(std::lround(static_cast<double>(camera.width) / kTileColumns)))),
      camera_(camera.Every(step_)),
      memory_(std::make_unique<Memory>()) {}

MovingDetector::~MovingDetector() = default;

std::shared_ptr<const MovingMask> MovingDetector::Find(const Input& input, const BlockMap& map, ViewPredictor& predictor) {
    Memory& m = *memory_;
    Moments moments(config_, camera_, m);
    moments.Take(input, step_);
    const Changes changes = moments.Compare();
    if (m.past.empty() || m.now.stamp_s - m.past.back().stamp_s >= kSpacing * config_.window_s) m.past.push_back(m.now);
    std::shared_ptr<MovingMask> mask;
    if (changes.any) {
        PredictedView view;
        predictor.Predict(map, camera_.Every(kAsked), input.T_world_camera, kNearest_m, 1.2f * input.farthest_m, view);
        Evidence evidence = moments.Weigh(changes, view.depth_m);
        if (!evidence.fits) evidence.candidates = evidence.seeds = evidence.gone = Marks(camera_.width, camera_.height);
        moments.Decide(evidence);
        mask = std::make_shared<MovingMask>();
        mask->step = step_;
        mask->moving = m.moving;
        Dilate(kAround, mask->moving);
        mask->moving_tiles = CountOf(mask->moving);
        mask->gone_tiles = CountOf(evidence.gone);
        Dilate(kAround, evidence.gone);
        mask->gone_m = DepthImage(camera_.width, camera_.height);
        for (std::size_t i = 0; i < mask->gone_m.size(); ++i)
            if (evidence.gone.data()[i] != 0) mask->gone_m.data()[i] = m.now.near_m.data()[i];
    }
    if (!mask || mask->moving_tiles == 0) m.moving = {};
    if (!mask || mask->moving_tiles + mask->gone_tiles == 0) return nullptr;
    return mask;
}

std::shared_ptr<const MovingMask> MovingDetector::Expect(double stamp_s, const Eigen::Isometry3d& T_world_camera) const {
    constexpr double kLongest_s = 0.2;  // between two frames
    const Memory& m = *memory_;
    if (m.moving.empty() || std::abs(stamp_s - m.now.stamp_s) > kLongest_s) return nullptr;
    DepthImage carried_m(camera_.width, camera_.height);
    Carry(m.now, m.moving, T_world_camera, camera_, carried_m);
    auto mask = std::make_shared<MovingMask>();
    mask->step = step_;
    mask->moving = Marks(camera_.width, camera_.height);
    for (std::size_t i = 0; i < mask->moving.size(); ++i) mask->moving.data()[i] = carried_m.data()[i] > 0;
    Dilate(kExpectedAround, mask->moving);
    mask->moving_tiles = CountOf(mask->moving);
    return mask;
}

void MovingDetector::Move(const Eigen::Isometry3d& T_new_old) {
    for (TileView& view : memory_->past) view.T_world_camera = T_new_old * view.T_world_camera;
    memory_->now.T_world_camera = T_new_old * memory_->now.T_world_camera;
}

void MovingDetector::Clear() { *memory_ = {}; }

void MovingDetector::Config::Describe(ConfigParameters& p) {
    p.Add("enabled", enabled, "people and other moving things are neither tracked on nor fused (docs/moving.md); off where nothing moves saves a twentieth of a frame");
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
