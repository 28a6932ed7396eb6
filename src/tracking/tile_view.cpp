#include "tracking/tile_view.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "mapping/frame_kernels.h"

namespace tessera {
namespace {

constexpr float kNone = std::numeric_limits<float>::max();

float NearestOfTile(const DepthImage& depth_m, int step, int k, int l) {
    float nearest = kNone;
    int valid = 0;
    for (int y = l * step; y < (l + 1) * step; ++y) {
        const float* row = depth_m.row(y) + static_cast<std::ptrdiff_t>(k) * step;
        for (int x = 0; x < step; ++x) {
            const bool ok = row[x] > 0;
            valid += ok;
            nearest = std::min(nearest, ok ? row[x] : kNone);
        }
    }
    return 2 * valid >= step * step ? nearest : 0.0f;
}

// First along rows, then along columns.
template <class Better>
void BestAround(const DepthImage& tiles, int reach, DepthImage& out, float none,
                const Better& better) {
    const int width = tiles.width(), height = tiles.height();
    DepthImage rows(width, height);
    const auto value = [&](int x, int y) { return tiles(x, y) > 0 ? tiles(x, y) : none; };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            float best = none;
            for (int u = std::max(x - reach, 0); u <= std::min(x + reach, width - 1); ++u)
                best = better(best, value(u, y));
            rows(x, y) = best;
        }
    out.Resize(width, height);
    for (int y = 0; y < height; ++y) {
        std::fill_n(out.row(y), width, none);
        for (int v = std::max(y - reach, 0); v <= std::min(y + reach, height - 1); ++v)
            for (int x = 0; x < width; ++x) out(x, y) = better(out(x, y), rows(x, v));
        for (int x = 0; x < width; ++x)
            if (tiles(x, y) <= 0) out(x, y) = 0;
    }
}

// Visits each tile (x, y) of `from` that has depth and whose point a camera at this pose sees.
// Passes the point's depth and tile in that camera.
template <class Visit>
void ForEachVisibleTile(const TileView& from, const Eigen::Isometry3d& T_world_camera,
                        const PinholeCamera& camera, const Visit& visit) {
    const Eigen::Isometry3f T = (T_world_camera.inverse() * from.T_world_camera).cast<float>();
    const Eigen::Matrix3f R = T.linear();
    const Eigen::Vector3f t = T.translation();
    const auto fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy);
    const auto cx = static_cast<float>(camera.cx), cy = static_cast<float>(camera.cy);
    const int width = from.depth_m.width(), height = from.depth_m.height();
    constexpr float kNearest_m = 0.1f;
    for (int y = 0; y < height; ++y) {
        const Eigen::Vector3f row = R.col(1) * ((static_cast<float>(y) - cy) / fy) + R.col(2);
        for (int x = 0; x < width; ++x) {
            const float depth = from.depth_m(x, y);
            if (depth <= 0) continue;
            const Eigen::Vector3f p =
                depth * (R.col(0) * ((static_cast<float>(x) - cx) / fx) + row) + t;
            if (p.z() < kNearest_m) continue;
            const float u = p.x() / p.z() * fx + cx + 0.5f, v = p.y() / p.z() * fy + cy + 0.5f;
            if (u >= 0 && v >= 0 && u < static_cast<float>(width) && v < static_cast<float>(height))
                visit(x, y, p.z(), static_cast<int>(u), static_cast<int>(v));
        }
    }
}

}  // namespace

void MakeTiles(const DepthImage& depth_m, int step, float disparity_offset_per_m,
               DepthImage& tiles) {
    tiles.Resize(depth_m.width() / step, depth_m.height() / step);
    constexpr int kRows = 8;
    tbb::parallel_for(0, (tiles.height() + kRows - 1) / kRows, [&](int band) {
        for (int l = band * kRows; l < std::min((band + 1) * kRows, tiles.height()); ++l)
            for (int k = 0; k < tiles.width(); ++k)
                tiles(k, l) =
                    CorrectedDepth(NearestOfTile(depth_m, step, k, l), disparity_offset_per_m);
    });
}

void NearestInWindow(const DepthImage& tiles, int reach, DepthImage& nearest) {
    BestAround(tiles, reach, nearest, kNone, [](float a, float b) { return std::min(a, b); });
}

void FarthestInWindow(const DepthImage& tiles, int reach, DepthImage& farthest) {
    BestAround(tiles, reach, farthest, 0.0f, [](float a, float b) { return std::max(a, b); });
}

void MarkFree(const TileView& from, const TileView& to, const PinholeCamera& camera,
              const DepthMargin& margin, Image<std::uint8_t>& of_from) {
    ForEachVisibleTile(from, to.T_world_camera, camera,
                       [&](int x, int y, float depth_m, int k, int l) {
                           const float seen = to.near_m(k, l);
                           if (seen > depth_m + margin(seen)) of_from(x, y) = 1;
                       });
}

void MarkSame(const TileView& from, const TileView& to, const PinholeCamera& camera,
              const DepthMargin& margin, Image<std::uint8_t>& of_from) {
    ForEachVisibleTile(
        from, to.T_world_camera, camera, [&](int x, int y, float depth_m, int k, int l) {
            const float nearest = to.near_m(k, l), there = to.depth_m(k, l), off = margin(depth_m);
            if (there > 0 && nearest - off <= depth_m && depth_m <= there + off) of_from(x, y) = 1;
        });
}

void FindDeparted(const TileView& past, const TileView& now, const PinholeCamera& camera,
                  const DepthMargin& margin, DepthImage& left_m) {
    ForEachVisibleTile(past, now.T_world_camera, camera,
                       [&](int, int, float depth_m, int k, int l) {
                           const float seen = now.near_m(k, l);
                           if (seen <= depth_m + margin(seen)) return;
                           if (left_m(k, l) <= 0 || depth_m < left_m(k, l)) left_m(k, l) = depth_m;
                       });
}

void ReprojectMarks(const TileView& from, const Image<std::uint8_t>& marked,
                    const Eigen::Isometry3d& T_world_camera, const PinholeCamera& camera,
                    DepthImage& carried_m) {
    ForEachVisibleTile(from, T_world_camera, camera,
                       [&](int x, int y, float depth_m, int k, int l) {
                           if (marked(x, y) != 0) carried_m(k, l) = depth_m;
                       });
}

}  // namespace tessera
