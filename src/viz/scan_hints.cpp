#include "viz/scan_hints.h"

#include <vector>

#include "core/quantile.h"

namespace tessera {
namespace {

constexpr double kExposure_s = 1.0 / 60;
// A blur of one eightieth of the picture's width, 8 of 640 pixels, costs colour and features.
constexpr double kMostBlur = 1.0 / 80;
constexpr double kFast_m_s = 0.8;
constexpr double kFewDepths = 0.4, kMuchTooFar = 0.3, kNear_m = 0.7;
constexpr double kMuchThin = 0.5;
constexpr std::int64_t kSettled = 90;  // frames

}  // namespace

DepthShares SharesOf(const DepthImage& depth_m, double max_depth_m) {
    constexpr int kStep = 4;
    const auto limit_m = static_cast<float>(max_depth_m);
    std::vector<float> valid;
    std::size_t all = 0, too_far = 0;
    for (int y = 0; y < depth_m.height(); y += kStep)
        for (int x = 0; x < depth_m.width(); x += kStep, ++all) {
            const float z = depth_m(x, y);
            too_far += z > limit_m;
            if (z > 0 && z <= limit_m) valid.push_back(z);
        }
    DepthShares shares;
    if (all == 0) return shares;
    shares.valid = static_cast<double>(valid.size()) / static_cast<double>(all);
    shares.too_far = static_cast<double>(too_far) / static_cast<double>(all);
    if (valid.empty()) return shares;
    shares.median_m = Median(valid);
    return shares;
}

double Blur_px(const ScanSigns& s) {
    const double distance_m = s.depth.median_m > 0 ? s.depth.median_m : 1.5;
    return s.focal_px * kExposure_s * (s.turn_rad_s + s.speed_m_s / distance_m);
}

std::optional<ScanHint> HintFor(const ScanSigns& s) {
    if (s.status == TrackStatus::kLost)
        return ScanHint{6, "Lost: point the camera at a place that you have already scanned"};
    if (Blur_px(s) > kMostBlur * s.width_px || s.speed_m_s > kFast_m_s)
        return ScanHint{5, "Move slower: the picture blurs"};
    if (s.depth.valid < kFewDepths) {
        if (s.depth.too_far > kMuchTooFar)
            return ScanHint{4, "Too far: go closer, or raise the largest depth"};
        if (s.depth.median_m > 0 && s.depth.median_m < kNear_m)
            return ScanHint{4, "Too close: step back"};
        return ScanHint{
            3, "Little depth here: too close, or glass, a mirror, black or sunlit surfaces"};
    }
    if (s.status == TrackStatus::kPoor)
        return ScanHint{4, "Tracking is poor: point back at where you were"};
    if (s.degenerate)
        return ScanHint{2, "Little shape here: bring a corner or an object into view"};
    if (s.thin_share > kMuchThin && s.frames > kSettled)
        return ScanHint{1, "Red and orange surfaces are thin: go over them once more"};
    return std::nullopt;
}

const std::string& HintHolder::Update(const std::optional<ScanHint>& hint, double now_s) {
    const bool held = !shown_.text.empty() && now_s - since_s_ < kShown_s;
    if (hint && hint->text == shown_.text) {
        since_s_ = now_s;
    } else if (!held || (hint && hint->urgency > shown_.urgency)) {
        shown_ = hint.value_or(ScanHint{});
        since_s_ = now_s;
    }
    return shown_.text;
}

}  // namespace tessera
