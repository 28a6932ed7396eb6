#include "optimize/depth_distortion_estimator.h"

#include <algorithm>
#include <utility>

#include "core/quantile.h"
#include "core/se3.h"

namespace tessera {
namespace {

constexpr std::size_t kMostDepthPairs = 200;
// Of a pair: rotation, and translation as a share of the depth.
constexpr double kLeastApart_rad = 0.1, kMostApart_rad = 0.7, kLeastShift = 0.1, kMostShift = 0.6;

}  // namespace

DepthDistortionEstimator::DepthDistortionEstimator(const PinholeCamera& camera)
    : camera_(camera), aligner_({}, camera) {}

void DepthDistortionEstimator::StartPart() {
    ++part_;
    first_of_part_ = true;
    aligner_.Clear();
}

void DepthDistortionEstimator::Add(const Frame& frame) {
    if (frame.colour.empty()) return;
    PrepareFrame(frame, {}, prepared_);
    const Eigen::Isometry3d T_last_current =
        aligner_.Align(prepared_, Eigen::Isometry3d::Identity());
    T_part_camera_.push_back(first_of_part_ ? Eigen::Isometry3d::Identity()
                                            : Normalised(T_part_camera_.back() * T_last_current));
    first_of_part_ = false;
    part_of_.push_back(part_);
    depth_m_.push_back(MedianDepth(prepared_.depth_m));
    views_.push_back(MakeDepthView(frame.depth_m, camera_));
}

std::optional<DepthDistortionEstimate> DepthDistortionEstimator::Estimate() const {
    std::vector<DepthPair> candidates;
    for (std::size_t from = 0; from < views_.size(); ++from)
        for (std::size_t to = 0; to < views_.size(); ++to) {
            if (part_of_[from] != part_of_[to] || !(depth_m_[from] > 0)) continue;
            const Eigen::Isometry3d T = T_part_camera_[to].inverse() * T_part_camera_[from];
            const double turn = Eigen::AngleAxisd(T.linear()).angle(),
                         shift = T.translation().norm() / depth_m_[from];
            if (turn > kMostApart_rad || shift > kMostShift ||
                (turn < kLeastApart_rad && shift < kLeastShift))
                continue;
            candidates.push_back({static_cast<int>(from), static_cast<int>(to), T});
        }
    std::vector<DepthPair> pairs;
    const std::size_t count = std::min(kMostDepthPairs, candidates.size());
    for (std::size_t i = 0; i < count; ++i)
        pairs.push_back(candidates[i * candidates.size() / count]);
    return FitDepthDistortion(views_, camera_, std::move(pairs));
}

}  // namespace tessera
