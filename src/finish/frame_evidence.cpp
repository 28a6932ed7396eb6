#include "finish/frame_evidence.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/depth_noise.h"

namespace tessera {
namespace {

constexpr float kMapError_m = 0.01f;  // of the map against a frame, besides the frame's noise
constexpr int kReach_px = 2;          // of the pixels around

std::uint16_t Millimetres(float depth_m) {
    return static_cast<std::uint16_t>(std::clamp(1000 * depth_m + 0.5f, 0.0f, 32767.0f));
}

struct Around {  // depths around a pixel, millimetres
    std::uint16_t nearest = 32767, farthest = 0;
    bool gap = false;

    void Add(std::uint16_t depth) {
        gap |= depth == 0;
        if (depth > 0) nearest = std::min(nearest, depth);
        farthest = std::max(farthest, depth);
    }
    void Add(const Around& other) {
        gap |= other.gap;
        nearest = std::min(nearest, other.nearest);
        farthest = std::max(farthest, other.farthest);
    }
};

float Metres(int millimetres) { return 0.001f * static_cast<float>(millimetres); }

float Margin_m(float z_m) { return kMapError_m + 3 * DepthSigma_m(z_m); }

}  // namespace

void FrameEvidence::Add(const PinholeCamera& camera, const Frame& frame) {
    const DepthImage& depth_m = frame.depth_m;
    if (!frame.T_world_camera || depth_m.empty() ||
        static_cast<std::int64_t>(views_.size()) >= kMostFrames)
        return;
    const int width = (depth_m.width() + 1) / 2, height = (depth_m.height() + 1) / 2;
    View view{frame.T_world_camera->inverse().cast<float>(),
              static_cast<float>(camera.fx / 2),
              static_cast<float>(camera.fy / 2),
              static_cast<float>(camera.cx / 2),
              static_cast<float>(camera.cy / 2),
              Image<std::uint16_t>(width, height),
              Image<std::uint16_t>(width, height)};
    // Along the rows, then along the columns.
    Image<Around> rows(width, depth_m.height());
    tbb::parallel_for(0, depth_m.height(), [&](int y) {
        for (int x = 0; x < width; ++x)
            for (int u = std::max(2 * x - kReach_px, 0);
                 u <= std::min(2 * x + kReach_px, depth_m.width() - 1); ++u)
                rows(x, y).Add(Millimetres(depth_m(u, y)));
    });
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x) {
            Around around;
            for (int v = std::max(2 * y - kReach_px, 0);
                 v <= std::min(2 * y + kReach_px, depth_m.height() - 1); ++v)
                around.Add(rows(x, v));
            view.nearest(x, y) =
                static_cast<std::uint16_t>(around.nearest | (around.gap ? kGap : 0));
            view.farthest(x, y) = around.farthest;
        }
    });
    views_.push_back(std::move(view));
}

Evidence FrameEvidence::At(const Eigen::Vector3f& p_world) const {
    Evidence evidence;
    for (const View& view : views_) {
        const Eigen::Vector3f p = view.T_camera_world * p_world;
        if (!(p.z() > 0.1f)) continue;
        const float u = p.x() / p.z() * view.fx + view.cx, v = p.y() / p.z() * view.fy + view.cy;
        if (!(u >= 0 && v >= 0 && u < static_cast<float>(view.nearest.width()) - 1 &&
              v < static_cast<float>(view.nearest.height()) - 1))
            continue;
        const int x = static_cast<int>(u + 0.5f), y = static_cast<int>(v + 0.5f);
        const std::uint16_t nearest = view.nearest(x, y);
        const float nearest_m = Metres(nearest & ~kGap), farthest_m = Metres(view.farthest(x, y));
        if (farthest_m <= 0) continue;
        const float margin_m = Margin_m(p.z());
        if (nearest_m - Margin_m(nearest_m) > p.z())
            evidence.seen_through += (nearest & kGap) == 0;
        else if (std::abs(nearest_m - p.z()) <= margin_m ||
                 std::abs(farthest_m - p.z()) <= margin_m)
            ++evidence.confirmed;
    }
    return evidence;
}

}  // namespace tessera
