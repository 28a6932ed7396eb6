#include "finish/view_choice.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "finish/path_motion.h"
#include "finish/texture_view.h"

namespace tessera {
namespace {

// The first pose of each stretch; `longer`: how many times kStretch_m and kStretch_rad.
std::vector<std::size_t> Stretches(std::span<const StampedPose> path, double longer) {
    std::vector<std::size_t> first;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const Eigen::Isometry3d& T = path[i].T_world_camera;
        if (!first.empty()) {
            // A pose that is not a number ends no stretch.
            const Eigen::Isometry3d& T_first = path[first.back()].T_world_camera;
            const double moved_m = (T.translation() - T_first.translation()).norm();
            if (!(moved_m > longer * ViewChoice::kStretch_m) &&
                !(RotationAngle(T_first, T) > longer * ViewChoice::kStretch_rad))
                continue;
        }
        first.push_back(i);
    }
    return first;
}

}  // namespace

ViewChoice::ViewChoice(std::span<const StampedPose> path, const PinholeCamera& camera) {
    constexpr double kLonger = 1.2;
    double longer = 1;
    std::vector<std::size_t> first = Stretches(path, longer);
    while (first.size() > kMostStretches) first = Stretches(path, longer *= kLonger);
    first.push_back(path.size());
    for (std::size_t s = 0; s + 1 < first.size(); ++s) {
        std::vector<std::pair<float, std::size_t>> by_blur;
        for (std::size_t i = first[s]; i < first[s + 1]; ++i)
            by_blur.emplace_back(MotionBlur_px(TwistAt(path, path[i].stamp_s), camera), i);
        std::ranges::sort(by_blur);
        by_blur.resize(std::min(by_blur.size(), kCandidates));
        std::ranges::sort(by_blur, {}, [](const auto& candidate) { return candidate.second; });
        for (const auto& [blur_px, i] : by_blur) {
            stamps_s_.push_back(path[i].stamp_s);
            stretches_.push_back(static_cast<int>(s));
        }
    }
}

std::optional<std::size_t> ViewChoice::Find(const Frame& frame) const {
    const auto found = std::ranges::lower_bound(stamps_s_, frame.stamp_s - kSame_s);
    if (found == stamps_s_.end() || *found > frame.stamp_s + kSame_s) return std::nullopt;
    return static_cast<std::size_t>(found - stamps_s_.begin());
}

std::optional<Frame> ViewChoice::Offer(const Frame& frame, std::size_t number) {
    std::optional<Frame> finished;
    if (stretches_[number] != stretch_) finished = std::exchange(best_, std::nullopt);
    stretch_ = stretches_[number];
    const double sharpness = Sharpness(frame.colour);
    if (!best_ || sharpness > best_sharpness_) {
        best_ = frame;
        best_sharpness_ = sharpness;
    }
    return finished;
}

std::optional<Frame> ViewChoice::Last() { return std::exchange(best_, std::nullopt); }

}  // namespace tessera
