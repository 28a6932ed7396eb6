#include "optimize/edge_view.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

constexpr int kEdgeColumns = 320;
constexpr float kNearestEdge_m = 0.3f, kFarthestEdge_m = 4;
// What lies behind an edge is farther by more than this share, and at most so many columns away; a
// shadow may lie between. In front of the edge the surface goes on for some columns.
constexpr float kStep = 1.08f, kLevel = 0.03f;
constexpr int kShadow = 12, kSurface = 3;
constexpr std::size_t kMostKept = 1000;
constexpr float kWeakEdge = 4;  // grey levels per column that count half
static_assert(EdgeView::kBorder > kShadow);

// Every step-th pixel. Luma is smoothed before by 1-2-1 in both directions.
struct SmallView {
    DepthImage depth_m;
    Image<float> luma;
};

SmallView Shrink(const Frame& frame, int step) {
    const int width = frame.depth_m.width() / step, height = frame.depth_m.height() / step;
    const auto luma = [&](int x, int y) {
        const Rgb8 c = frame.colour(std::clamp(x, 0, frame.colour.width() - 1),
                                    std::clamp(y, 0, frame.colour.height() - 1));
        return 0.299f * static_cast<float>(c.r) + 0.587f * static_cast<float>(c.g) +
               0.114f * static_cast<float>(c.b);
    };
    SmallView view{DepthImage(width, height), Image<float>(width, height)};
    constexpr std::array<float, 3> kWeights = {0.25f, 0.5f, 0.25f};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int u = x * step + step / 2, v = y * step + step / 2;
            view.depth_m(x, y) = frame.depth_m(u, v);
            float sum = 0;
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i)
                    sum += kWeights[static_cast<std::size_t>(i + 1)] *
                           kWeights[static_cast<std::size_t>(j + 1)] * luma(u + i, v + j);
            view.luma(x, y) = sum;
        }
    return view;
}

// Strength of luma's edges across `dx`, `dy`, from 0 to 1. 0 at the border.
Image<float> EdgeStrength(const Image<float>& luma, int dx, int dy) {
    Image<float> strength(luma.width(), luma.height());
    for (int y = 1; y < luma.height() - 1; ++y)
        for (int x = 1; x < luma.width() - 1; ++x) {
            const float slope = std::abs(luma(x + dx, y + dy) - luma(x - dx, y - dy)) / 2;
            strength(x, y) = slope / (slope + kWeakEdge);
        }
    return strength;
}

// Whether a near surface ends at (x, y) in this direction: it goes on behind, and the next depth
// ahead is clearly farther. (x, y) is at least kShadow pixels away from the border.
bool EndsAt(const DepthImage& depth_m, int x, int y, int dx, int dy) {
    const float z_m = depth_m(x, y);
    if (!(z_m > kNearestEdge_m) || !(z_m < kFarthestEdge_m)) return false;
    for (int k = 1; k <= kSurface; ++k)
        if (!(std::abs(depth_m(x - k * dx, y - k * dy) - z_m) < kLevel * z_m)) return false;
    for (int k = 1; k <= kShadow; ++k)
        if (const float ahead_m = depth_m(x + k * dx, y + k * dy); ahead_m > 0)
            return ahead_m > kStep * z_m;
    return false;
}

}  // namespace

EdgeView MakeEdgeView(const Frame& frame) {
    EdgeView edges;
    if (frame.colour.empty() || frame.colour.width() != frame.depth_m.width()) return edges;
    edges.step_px = std::max(1, (frame.depth_m.width() + kEdgeColumns / 2) / kEdgeColumns);
    const SmallView view = Shrink(frame, edges.step_px);
    edges.across = EdgeStrength(view.luma, 1, 0);
    edges.down = EdgeStrength(view.luma, 0, 1);
    for (std::size_t d = 0; d < edges.ends.size(); ++d) {
        const auto [dx, dy] = EdgeView::kAhead[d];
        std::vector<EdgeView::End> all;
        for (int y = EdgeView::kBorder; y < view.luma.height() - EdgeView::kBorder; ++y)
            for (int x = EdgeView::kBorder; x < view.luma.width() - EdgeView::kBorder; ++x)
                if (EndsAt(view.depth_m, x, y, dx, dy))
                    all.push_back({static_cast<std::int16_t>(x), static_cast<std::int16_t>(y),
                                   view.depth_m(x, y)});
        const std::size_t every = 1 + all.size() / kMostKept;
        for (std::size_t e = 0; e < all.size(); e += every) edges.ends[d].push_back(all[e]);
    }
    return edges;
}

}  // namespace tessera
