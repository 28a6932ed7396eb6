#include "tracking/tile_regions.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

using Marks = Image<std::uint8_t>;
constexpr float kNearestCounted_m = 1.0f;  // noise covers a few tiles, near and far

// Whether neighbours belong to one surface. Tiles of a slanted surface differ, too.
bool Continuous(float a, float b) {
    return a > 0 && b > 0 && std::abs(a - b) < 0.05f + 0.03f * std::min(a, b);
}

// Whether neighbours belong to one body: a chin in front of a chest, an arm in front of a hip.
bool SameBody(float a, float b) { return a > 0 && b > 0 && std::abs(a - b) < 0.2f; }

template <class Visit>
void ForNeighbours(const Marks& marks, int x, int y, const Visit& visit) {
    constexpr int kSteps[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    for (const auto& [dx, dy] : kSteps)
        if (marks.Contains(x + dx, y + dy)) visit(x + dx, y + dy);
}

bool IsCore(const Marks& marks, int x, int y) {
    for (int v = y - 1; v <= y + 1; ++v)
        for (int u = x - 1; u <= x + 1; ++u)
            if (!marks.Contains(u, v) || marks(u, v) == 0) return false;
    return true;
}

}  // namespace

bool HasCore(const Marks& marks) {
    for (int y = 1; y + 1 < marks.height(); ++y)
        for (int x = 1; x + 1 < marks.width(); ++x)
            if (marks(x, y) != 0 && IsCore(marks, x, y)) return true;
    return false;
}

void KeepRegions(const DepthImage& depth_m, const Marks& seeds, const PinholeCamera& camera,
                 const RegionRule& rule, Marks& marks) {
    constexpr std::uint8_t kOpen = 1, kKept = 2, kLeft = 3;
    std::vector<std::pair<int, int>> region;
    for (int y0 = 0; y0 < marks.height(); ++y0)
        for (int x0 = 0; x0 < marks.width(); ++x0) {
            if (marks(x0, y0) != kOpen) continue;
            region.assign(1, {x0, y0});
            marks(x0, y0) = kLeft;
            double area_m2 = 0, seeded = 0;
            bool core = false;
            for (std::size_t i = 0; i < region.size(); ++i) {
                const auto [x, y] = region[i];
                const float depth = depth_m(x, y);
                const float from_m = std::max(depth, kNearestCounted_m);
                area_m2 += from_m * from_m / (camera.fx * camera.fy);
                seeded += seeds(x, y) != 0;
                core = core || IsCore(seeds, x, y);
                ForNeighbours(marks, x, y, [&](int u, int v) {
                    if (marks(u, v) != kOpen || !Continuous(depth, depth_m(u, v))) return;
                    marks(u, v) = kLeft;
                    region.emplace_back(u, v);
                });
            }
            if (core && area_m2 >= rule.min_area_m2 &&
                seeded >= rule.min_seed_fraction * static_cast<double>(region.size()))
                for (const auto& [x, y] : region) marks(x, y) = kKept;
        }
    std::transform(marks.data(), marks.data() + marks.size(), marks.data(),
                   [](std::uint8_t m) { return static_cast<std::uint8_t>(m == kKept); });
}

void GrowRegions(const DepthImage& depth_m, const Marks& allowed, const PinholeCamera& camera,
                 double reach_m, Marks& marks) {
    struct Tile {
        int x, y;
        double path_length_m;
    };
    std::vector<Tile> tiles;  // roughly in order of distance from the regions
    for (int y = 0; y < marks.height(); ++y)
        for (int x = 0; x < marks.width(); ++x)
            if (marks(x, y) != 0) tiles.push_back({x, y, 0});
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const Tile from = tiles[i];
        const double path_length_m = from.path_length_m + depth_m(from.x, from.y) / camera.fx;
        if (path_length_m > reach_m) continue;
        ForNeighbours(marks, from.x, from.y, [&](int u, int v) {
            if (marks(u, v) != 0 || allowed(u, v) == 0 ||
                !SameBody(depth_m(from.x, from.y), depth_m(u, v)))
                return;
            marks(u, v) = 1;
            tiles.push_back({u, v, path_length_m});
        });
    }
}

void MarkNear(const DepthImage& depth_m, const DepthImage& other_m, int reach, Marks& marks) {
    for (int y = 0; y < other_m.height(); ++y)
        for (int x = 0; x < other_m.width(); ++x) {
            if (other_m(x, y) <= 0) continue;
            for (int v = std::max(y - reach, 0); v <= std::min(y + reach, other_m.height() - 1);
                 ++v)
                for (int u = std::max(x - reach, 0); u <= std::min(x + reach, other_m.width() - 1);
                     ++u)
                    if (Continuous(other_m(x, y), depth_m(u, v))) marks(u, v) = 1;
        }
}

void Dilate(int reach, Marks& marks) {
    for (int step = 0; step < reach; ++step) {
        const Marks before = marks;
        for (int y = 0; y < marks.height(); ++y)
            for (int x = 0; x < marks.width(); ++x)
                if (before(x, y) != 0)
                    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, marks.height() - 1); ++v)
                        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, marks.width() - 1);
                             ++u)
                            marks(u, v) = 1;
    }
}

}  // namespace tessera
