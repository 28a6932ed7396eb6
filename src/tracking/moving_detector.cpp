#include "tracking/moving_detector.h"

#include <algorithm>
#include <cmath>

#include "tracking/moving_evidence.h"
#include "tracking/tile_regions.h"

namespace tessera {
namespace {

using Marks = Image<std::uint8_t>;
constexpr int kTileColumns = 128;  // approximately
constexpr double kSpacing = 0.1;   // between remembered frames, in windows
constexpr float kNearest_m = 0.1f;
constexpr int kAround = 2, kExpectedAround = 3;  // tiles

bool Marked(std::uint8_t mark) { return mark != 0; }
std::int64_t CountOf(const Marks& marks) {
    return std::count_if(marks.data(), marks.data() + marks.size(), Marked);
}

}  // namespace

MovingDetector::MovingDetector(const Config& config, const PinholeCamera& camera)
    : config_(config),
      step_(std::max(
          1, static_cast<int>(std::lround(static_cast<double>(camera.width) / kTileColumns)))),
      camera_(camera.Every(step_)),
      memory_(std::make_unique<MovingHistory>()) {}

MovingDetector::~MovingDetector() = default;

std::shared_ptr<const MovingMask> MovingDetector::Find(const Input& input, const BlockMap& map,
                                                       ViewPredictor& predictor) {
    MovingHistory& m = *memory_;
    MovingAnalysis moments(config_, camera_, m);
    moments.Ingest(input, step_, map);
    const DepthChanges changes = moments.Compare();
    if (m.past.empty() || m.now.stamp_s - m.past.back().stamp_s >= kSpacing * config_.window_s)
        m.past.push_back(m.now);
    if (m.hint.stamp_s == input.stamp_s) {
        m.hint.T_world_camera = input.T_world_camera;
        m.hint_placed = true;
    }
    const DepthImage hinted_m =
        m.CarriedHint(input.stamp_s, input.T_world_camera, camera_, config_.window_s);
    std::shared_ptr<MovingMask> mask;
    if (changes.any || !hinted_m.empty()) {
        PredictedView view;
        predictor.Predict(map, camera_.Every(kMapQueryStride), input.T_world_camera, kNearest_m,
                          1.2f * input.farthest_m, view);
        MovingEvidence evidence = moments.Evaluate(changes, hinted_m, map, view.depth_m);
        if (!evidence.fits)
            evidence.candidates = evidence.seeds = evidence.gone =
                Marks(camera_.width, camera_.height);
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

std::shared_ptr<const MovingMask> MovingDetector::PredictMask(
    double stamp_s, const Eigen::Isometry3d& T_world_camera) const {
    // Between two frames. A slow camera's come later.
    constexpr double kLongest_s = 0.2, kLongest = 1.5;  // the latter in usual intervals
    const MovingHistory& m = *memory_;
    const double usual_s = m.intervals > 0 ? m.intervals_s / m.intervals : 0,
                 longest_s = std::max(kLongest_s, std::min(kLongest * usual_s, config_.window_s));
    const bool moved = !m.moving.empty() && std::abs(stamp_s - m.now.stamp_s) <= longest_s;
    DepthImage carried_m = m.CarriedHint(stamp_s, T_world_camera, camera_, config_.window_s);
    if (!moved && carried_m.empty()) return nullptr;
    if (carried_m.empty()) carried_m = DepthImage(camera_.width, camera_.height);
    if (moved) ReprojectMarks(m.now, m.moving, T_world_camera, camera_, carried_m);
    auto mask = std::make_shared<MovingMask>();
    mask->step = step_;
    mask->moving = Marks(camera_.width, camera_.height);
    for (std::size_t i = 0; i < mask->moving.size(); ++i)
        mask->moving.data()[i] = carried_m.data()[i] > 0;
    Dilate(kExpectedAround, mask->moving);
    mask->moving_tiles = CountOf(mask->moving);
    return mask;
}

void MovingDetector::SetHint(const MovingHint& hint, float disparity_offset_per_m,
                             const std::optional<Eigen::Isometry3d>& T_world_camera) {
    TileView& view = memory_->hint;
    view.stamp_s = hint.stamp_s;
    // If unknown, Find sets the pose.
    memory_->hint_placed = T_world_camera.has_value();
    if (T_world_camera) view.T_world_camera = *T_world_camera;
    MakeTiles(hint.depth_m, step_, disparity_offset_per_m, view.depth_m);
}

void MovingDetector::Move(const Eigen::Isometry3d& T_new_old) {
    for (TileView& view : memory_->past) {
        view.T_world_camera = T_new_old * view.T_world_camera;
        view.map_end = 0;  // another map
    }
    for (TileView* view : {&memory_->now, &memory_->hint})
        view->T_world_camera = T_new_old * view->T_world_camera;
}

void MovingDetector::Clear() { *memory_ = {}; }

void MovingDetector::Config::Describe(ConfigParameters& p) {
    p.Add("enabled", enabled,
          "exclude people and other moving objects from tracking and fusion (docs/moving.md); "
          "switch off in static scenes to save a twentieth of the time per frame");
    p.Add("window_s", window_s, {0.1, 10.0}, "s",
          "whatever has stood still for this long belongs to the scene; a shorter window accepts a "
          "moved chair sooner, a longer one copes with slower movers");
    p.Add("margin_m", margin_m, {0.005, 1.0}, "m",
          "depths that differ by less than this plus margin_per_m times the squared depth count as "
          "equal; covers sensor noise and pose errors");
    p.Add("margin_per_m", margin_per_m, {0.0, 0.1}, "1/m",
          "see margin_m; 0.01 is three times the noise of a structured-light sensor");
    p.Add("min_area_m2", min_area_m2, {0.0, 10.0}, "m^2", "smaller regions are ignored");
    p.Add("min_changed_fraction", min_changed_fraction, {0.01, 1.0}, "",
          "fraction of a region that must have changed within window_s for it to count as moving");
    p.Add("min_fitting_fraction", min_fitting_fraction, {0.0, 1.0}, "",
          "nothing counts as moving unless this fraction of the rest fits the map; otherwise the "
          "pose is wrong");
}

}  // namespace tessera
