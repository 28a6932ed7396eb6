#include "semantics/label_mapper.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <set>

namespace tessera {
namespace {

// Minimum number of columns of the predicted view and of the images compared with it.
constexpr int kSampledColumns = 160;
constexpr float kStrayShare = 0.02f;  // outlier pixels of an instance's outline, on each side
constexpr float kTrim = 0.05f;  // share of a detection's points cut off on each side of each axis

Eigen::AlignedBox3d BoxWithoutStrays(std::vector<Eigen::Vector3d>& points) {
    Eigen::AlignedBox3d box;
    if (points.empty()) return box;
    const auto cut = static_cast<std::size_t>(kTrim * static_cast<float>(points.size()));
    for (int axis = 0; axis < 3; ++axis) {
        std::ranges::sort(points, {}, [axis](const Eigen::Vector3d& p) { return p[axis]; });
        box.min()[axis] = points[cut][axis];
        box.max()[axis] = points[points.size() - 1 - cut][axis];
    }
    return box;
}

// Depends only on the detection, not on its place in the map: a corrected map yields the same mark.
std::uint64_t MarkOf(const Detection& d) {
    std::uint64_t mark = static_cast<std::uint64_t>(d.class_id);
    for (const float value : {d.probability, d.box.x_min, d.box.y_min, d.box.x_max, d.box.y_max}) {
        mark = (mark ^ std::bit_cast<std::uint32_t>(value)) * 0x9e3779b97f4a7c15u;
        mark ^= mark >> 29;
    }
    return mark;
}

Instances::Config InstanceConfig(const LabelConfig& config) {
    return {config.min_observations, config.min_rate};
}

}  // namespace

LabelMapper::LabelMapper(const LabelConfig& config, LabelClasses classes,
                         const PinholeCamera& camera, float max_depth_m)
    : config_(config),
      classes_(std::move(classes)),
      camera_(camera),
      max_depth_m_(max_depth_m),
      step_px_(std::max(1, camera.width / kSampledColumns)),
      instance_view_(config.prediction),
      instances_(InstanceConfig(config)) {}

VoteCount LabelMapper::Label(std::span<const Detection> detections, const DepthImage& measured_m,
                             const Eigen::Isometry3d& T_world_camera, BlockMap& map) {
    const float farthest_m =
        *std::max_element(measured_m.data(), measured_m.data() + measured_m.size());
    const DepthImage& depth_m = WithinReach(measured_m, farthest_m);
    // 1. Assign each pixel to a detection.
    MakeLabelImage(depth_m, camera_, detections, config_.region, image_);
    // 2. Predict the instances that the map shows.
    PredictInstances(T_world_camera, std::min(1.1f * farthest_m, max_depth_m_), map);
    const std::map<InstanceId, VisibleObject> visible = Visible();
    // 3. Match detections with instances.
    const std::vector<ObservedObject> observed = Observe(detections, depth_m, T_world_camera);
    const std::vector<InstanceId> match = instances_.Match(observed, visible, ignored_);
    // 4. Vote.
    std::vector<Ballot> ballots(detections.size());
    for (std::size_t i = 0; i < match.size(); ++i)
        if (match[i] != 0)
            ballots[i] = {static_cast<std::uint8_t>(detections[i].class_id), match[i],
                          visible.contains(match[i]),
                          instances_.Covered(observed[i], visible, match)};
    std::vector<Holder> holders(static_cast<std::size_t>(instances_.last()) + 1);
    for (const InstanceId id : instances_.ids()) {
        const InstanceId now = instances_.Resolve(id);
        holders[id] = {now, instances_.stands(now)};
    }
    const double band_m = config_.band_voxels * map.config().voxel_size_m;
    VoteCount count =
        VoteLabels(image_, ballots, holders, depth_m, camera_, T_world_camera, band_m, map);
    instance_view_.Voted(count.blocks);
    KnowBlocks(map);
    for (const BlockId id : count.blocks) votes_[static_cast<std::size_t>(id)] = Votes::kNew;
    return count;
}

const DepthImage& LabelMapper::WithinReach(const DepthImage& depth_m, float farthest_m) {
    if (!(farthest_m > max_depth_m_)) return depth_m;
    near_m_ = depth_m;
    std::replace_if(
        near_m_.data(), near_m_.data() + near_m_.size(),
        [this](float z) { return z > max_depth_m_; }, 0.0f);
    return near_m_;
}

void LabelMapper::PredictInstances(const Eigen::Isometry3d& T_world_camera, float farthest_m,
                                   const BlockMap& map) {
    instance_view_.Predict(map, camera_.Every(step_px_), T_world_camera, kNear_m,
                           std::max(2 * kNear_m, farthest_m), predicted_);
    std::transform(predicted_.data(), predicted_.data() + predicted_.size(), predicted_.data(),
                   [this](InstanceId voted) { return instances_.Resolve(voted); });
}

std::map<InstanceId, VisibleObject> LabelMapper::Visible() const {
    std::map<InstanceId, std::array<std::vector<int>, 2>> places;
    for (int y = 0; y < predicted_.height(); ++y)
        for (int x = 0; x < predicted_.width(); ++x) {
            if (predicted_(x, y) == 0) continue;
            auto& place = places[predicted_(x, y)];
            place[0].push_back(x);
            place[1].push_back(y);
        }
    std::map<InstanceId, VisibleObject> visible;
    for (auto& [id, place] : places) {
        VisibleObject& seen = visible[id];
        seen.pixels = static_cast<int>(place[0].size());
        const auto cut =
            static_cast<std::size_t>(kStrayShare * static_cast<float>(place[0].size()));
        for (std::size_t axis = 0; axis < 2; ++axis) {
            std::ranges::sort(place[axis]);
            seen.image_box.min()[static_cast<int>(axis)] = step_px_ * place[axis][cut];
            seen.image_box.max()[static_cast<int>(axis)] =
                step_px_ * (place[axis][place[axis].size() - 1 - cut] + 1);
        }
    }
    return visible;
}

std::vector<ObservedObject> LabelMapper::Observe(std::span<const Detection> detections,
                                                 const DepthImage& depth_m,
                                                 const Eigen::Isometry3d& T_world_camera) const {
    std::vector<ObservedObject> observed(std::min(detections.size(), LabelImage::kMostDetections));
    std::vector<std::vector<Eigen::Vector3d>> points(observed.size());
    const double pixel_m2 = step_px_ * step_px_ / (camera_.fx * camera_.fy);  // at 1 m
    for (int y = 0; y < predicted_.height(); ++y)
        for (int x = 0; x < predicted_.width(); ++x) {
            const int u = x * step_px_ + step_px_ / 2, v = y * step_px_ + step_px_ / 2;
            if (depth_m(u, v) <= 0) continue;
            for (const std::uint8_t label : {image_.detection(u, v), image_.second(u, v)}) {
                if (label == 0 || label == LabelImage::kBesideObjects) continue;
                ObservedObject& o = observed[label - 1u];
                ++o.pixels;
                o.area_m2 += pixel_m2 * depth_m(u, v) * depth_m(u, v);
                o.own_pixels += label == image_.detection(u, v);
                if (predicted_(x, y) != 0) ++o.overlaps[predicted_(x, y)];
                points[label - 1u].push_back(T_world_camera *
                                             camera_.Unproject(u, v, depth_m(u, v)));
            }
        }
    for (std::size_t i = 0; i < observed.size(); ++i) {
        observed[i].class_id = detections[i].class_id;
        observed[i].probability = detections[i].probability;
        observed[i].mark = MarkOf(detections[i]);
        observed[i].embedding.assign(detections[i].embedding.begin(),
                                     detections[i].embedding.end());
        observed[i].box = BoxWithoutStrays(points[i]);
        const DetectionBox& box = detections[i].box;
        observed[i].image_box = {Eigen::Vector2d(box.x_min, box.y_min),
                                 Eigen::Vector2d(box.x_max + 1, box.y_max + 1)};
    }
    return observed;
}

void LabelMapper::Reset() {
    instances_ = Instances(InstanceConfig(config_));
    MapMoved();
    loaded_ = false;
}

void LabelMapper::MapMoved() {
    votes_.clear();
    shown_.clear();
    away_.clear();
    loaded_ = true;
}

void LabelMapper::SaveState(StateWriter& state) const {
    state.Put(classes_.count());
    for (int id = 1; id <= classes_.count(); ++id) state.Put(classes_.name(id));
    instances_.SaveState(state);
}

std::optional<std::vector<std::string>> LabelMapper::LoadClassNames(StateReader& state) {
    int count = 0;
    if (!state.Get(count) || count < 0 || count > LabelClasses::kMost) return std::nullopt;
    std::vector<std::string> names(static_cast<std::size_t>(count));
    for (std::string& name : names)
        if (!state.Get(name)) return std::nullopt;
    return names;
}

bool LabelMapper::LoadState(StateReader& state) {
    const auto names = LoadClassNames(state);
    if (!names || std::ssize(*names) != classes_.count()) return false;
    for (int id = 1; id <= classes_.count(); ++id)
        if ((*names)[static_cast<std::size_t>(id - 1)] != classes_.name(id)) return false;
    loaded_ = true;
    return instances_.LoadState(state);
}

}  // namespace tessera
