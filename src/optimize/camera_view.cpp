#include "optimize/camera_view.h"

#include <algorithm>
#include <cmath>

#include "core/quantile.h"

namespace tessera {
namespace {

constexpr int kColumns = 320;
constexpr float kSmooth = 0.03f;      // share of the depth; larger steps are discontinuities
constexpr float kLeastSlope = 0.01f;  // intensity gradient per pixel; smaller ones are noise
constexpr float kNearest_m = 0.3f, kFarthest_m = 6;
constexpr std::size_t kMostPoints = 4000;

using Level = CameraView::Level;

Level FinestLevel(const Frame& frame, int n) {
    Level level;
    level.reduction = n;
    level.intensity.Resize(frame.colour.width() / n, frame.colour.height() / n);
    level.depth_m.Resize(level.intensity.width(), level.intensity.height());
    for (int y = 0; y < level.intensity.height(); ++y)
        for (int x = 0; x < level.intensity.width(); ++x) {
            int luma = 0, known = 0;
            float nearest = kFarthest_m, farthest = 0, sum = 0;
            for (int j = n * y; j < n * y + n; ++j)
                for (int i = n * x; i < n * x + n; ++i) {
                    const Rgb8& c = frame.colour(i, j);
                    luma += 77 * c.r + 150 * c.g + 29 * c.b;
                    const float z = frame.depth_m(i, j);
                    known += z > 0;
                    sum += z;
                    nearest = std::min(nearest, z);
                    farthest = std::max(farthest, z);
                }
            level.intensity(x, y) =
                static_cast<float>(luma) / (256.0f * 255.0f * static_cast<float>(n * n));
            const bool whole = known == n * n && farthest - nearest < kSmooth * nearest;
            level.depth_m(x, y) = whole ? sum / static_cast<float>(known) : 0.0f;
        }
    return level;
}

Level Halved(const Level& fine) {
    Level level;
    level.reduction = 2 * fine.reduction;
    level.intensity.Resize(fine.intensity.width() / 2, fine.intensity.height() / 2);
    level.depth_m.Resize(level.intensity.width(), level.intensity.height());
    for (int y = 0; y < level.intensity.height(); ++y)
        for (int x = 0; x < level.intensity.width(); ++x) {
            float luma = 0, sum = 0, nearest = kFarthest_m, farthest = 0;
            int known = 0;
            for (int j = 2 * y; j < 2 * y + 2; ++j)
                for (int i = 2 * x; i < 2 * x + 2; ++i) {
                    luma += fine.intensity(i, j);
                    const float z = fine.depth_m(i, j);
                    if (z <= 0) continue;
                    ++known;
                    sum += z;
                    nearest = std::min(nearest, z);
                    farthest = std::max(farthest, z);
                }
            level.intensity(x, y) = 0.25f * luma;
            const bool whole = known >= 2 && farthest - nearest < 2 * kSmooth * nearest;
            level.depth_m(x, y) = whole ? sum / static_cast<float>(known) : 0.0f;
        }
    return level;
}

bool Smooth(const DepthImage& depth_m, int x, int y) {
    const float z = depth_m(x, y);
    if (z < kNearest_m || z > kFarthest_m) return false;
    for (int j = y - 1; j <= y + 1; ++j)
        for (int i = x - 1; i <= x + 1; ++i)
            if (std::abs(depth_m(i, j) - z) > 2 * kSmooth * z) return false;
    return true;
}

std::uint8_t RegionOf(const Level& level, int x, int y, float du, float dv, float middle_m) {
    const float width = static_cast<float>(level.intensity.width()),
                height = static_cast<float>(level.intensity.height());
    const float right = 2 * static_cast<float>(x) / width - 1,
                down = 2 * static_cast<float>(y) / height - 1;
    const int ring =
        std::min(CameraView::kRings - 1, static_cast<int>(2 * std::hypot(right, down)));
    const int quarter = (right > 0 ? 1 : 0) + (down > 0 ? 2 : 0);
    const int far = level.depth_m(x, y) > middle_m ? 1 : 0,
              upright = std::abs(du) > std::abs(dv) ? 1 : 0;
    return static_cast<std::uint8_t>(
        ((ring * CameraView::kQuarters + quarter) * CameraView::kDepths + far) *
            CameraView::kDirections +
        upright);
}

void FindPoints(Level& level) {
    const Image<float>& image = level.intensity;
    const float middle_m = MedianDepth(level.depth_m);
    for (int y = 2; y < image.height() - 2; ++y)
        for (int x = 2; x < image.width() - 2; ++x) {
            const float du = 0.5f * (image(x + 1, y) - image(x - 1, y)),
                        dv = 0.5f * (image(x, y + 1) - image(x, y - 1));
            if (du * du + dv * dv < kLeastSlope * kLeastSlope || !Smooth(level.depth_m, x, y))
                continue;
            level.points.push_back({static_cast<float>(x), static_cast<float>(y),
                                    level.depth_m(x, y), image(x, y),
                                    RegionOf(level, x, y, du, dv, middle_m)});
        }
    const std::size_t count = level.points.size(), kept = std::min(count, kMostPoints);
    for (std::size_t i = 0; i < kept; ++i) level.points[i] = level.points[i * count / kept];
    level.points.resize(kept);
}

}  // namespace

CameraView MakeCameraView(const Frame& frame) {
    CameraView view;
    view.stamp_s = frame.stamp_s;
    view.levels[2] =
        FinestLevel(frame, std::max(1, (frame.colour.width() + kColumns / 2) / kColumns));
    view.levels[1] = Halved(view.levels[2]);
    view.levels[0] = Halved(view.levels[1]);
    for (Level& level : view.levels) FindPoints(level);
    return view;
}

PinholeCamera Averaged(const PinholeCamera& camera, int n) {
    return {camera.width / n, camera.height / n,           camera.fx / n,
            camera.fy / n,    (camera.cx + 0.5) / n - 0.5, (camera.cy + 0.5) / n - 0.5};
}

}  // namespace tessera
