#include "finish/atlas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>

namespace tessera {
namespace {

constexpr double kWidest_m = 1;       // of a texel; none is so wide
constexpr double kLargest = 1 << 20;  // texels; fits into no texture

Eigen::Vector2i BoxOf(const Chart& chart, double texel_m) {
    const auto side = [&](float metres) {
        return static_cast<int>(std::min(std::ceil(metres / texel_m), kLargest)) + 1 +
               2 * Atlas::kMargin;
    };
    return {side(chart.size_m.x()), side(chart.size_m.y())};
}

// Rows of boxes, the highest first. Returns the height; no corners are set if it exceeds max_side.
std::int64_t PackRows(const std::vector<Eigen::Vector2i>& boxes,
                      const std::vector<std::size_t>& by_height, int width, Atlas& atlas) {
    std::int64_t x = 0, y = 0, row = 0;
    for (const std::size_t i : by_height) {
        if (x + boxes[i].x() > width) {
            y += row;
            x = row = 0;
        }
        row = std::max<std::int64_t>(row, boxes[i].y());
        atlas.corner[i] = Eigen::Vector2i(static_cast<int>(x),
                                          static_cast<int>(std::min<std::int64_t>(y, 1 << 28))) +
                          Eigen::Vector2i::Constant(Atlas::kMargin);
        x += boxes[i].x();
    }
    return y + row;
}

}  // namespace

Result<Atlas> PackCharts(const std::vector<Chart>& charts, double texel_m, int max_side) {
    const Status too_many = Status::Error(fmt::format(
        "the surface is in too many pieces for a texture of {} x {}: {} charts; take a larger "
        "--texture, a larger --island, which removes small pieces, or a part of it by --box",
        max_side, max_side, charts.size()));
    // With the largest texels.
    std::int64_t least = 0;
    for (const Chart& chart : charts) least += BoxOf(chart, kWidest_m).cast<std::int64_t>().prod();
    if (least > std::int64_t{max_side} * max_side) return too_many;
    Atlas atlas;
    atlas.corner.resize(charts.size());
    for (atlas.texel_m = texel_m; atlas.texel_m < kWidest_m; atlas.texel_m *= 1.05) {
        std::vector<Eigen::Vector2i> boxes;
        int widest = 1;
        for (const Chart& chart : charts) {
            boxes.push_back(BoxOf(chart, atlas.texel_m));
            widest = std::max(widest, boxes.back().x());
        }
        std::vector<std::size_t> by_height(charts.size());
        std::iota(by_height.begin(), by_height.end(), std::size_t{0});
        std::ranges::stable_sort(by_height, std::greater<>(),
                                 [&](std::size_t i) { return boxes[i].y(); });
        for (int width = 64; width <= max_side; width *= 2) {
            if (widest > width) continue;
            const std::int64_t height = PackRows(boxes, by_height, width, atlas);
            if (height > std::min(width, max_side)) continue;
            atlas.width = width;
            atlas.height = static_cast<int>(std::max<std::int64_t>((height + 3) / 4 * 4, 4));
            return atlas;
        }
    }
    return too_many;
}

}  // namespace tessera
