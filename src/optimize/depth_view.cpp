#include "optimize/depth_view.h"

#include <algorithm>
#include <cmath>

#include "optimize/camera_view.h"

namespace tessera {
namespace {

constexpr int kViewColumns = 160;
constexpr float kSpread = 0.04f;  // of the depths within a block, as a share of the depth
constexpr float kBend = 0.02f;    // of the inverse depth across five blocks, as a share of it

// Mean over a block; 0 if a pixel has no depth or the surface is not smooth.
float MeanInverse(const DepthImage& depth_m, int x, int y, int size) {
    float sum = 0, low = 1e9f, high = 0;
    for (int v = y; v < y + size; ++v)
        for (int u = x; u < x + size; ++u) {
            const float z = depth_m(u, v);
            low = std::min(low, z);
            high = std::max(high, z);
            sum += 1 / std::max(z, 1e-3f);
        }
    return low > 0 && high - low <= kSpread * high ? sum / static_cast<float>(size * size) : 0;
}

// Mean of 3 x 3 pixels; 0 if one of the 5 x 5 around (x, y) is missing.
float Smoothed(const Image<float>& image, int x, int y) {
    float sum = 0;
    for (int v = y - 2; v <= y + 2; ++v)
        for (int u = x - 2; u <= x + 2; ++u) {
            if (image(u, v) <= 0) return 0;
            if (std::abs(u - x) <= 1 && std::abs(v - y) <= 1) sum += image(u, v);
        }
    return sum / 9;
}

}  // namespace

DepthView MakeDepthView(const DepthImage& depth_m, const PinholeCamera& camera) {
    DepthView view;
    view.reduction = std::max(1, depth_m.width() / kViewColumns);
    const int width = depth_m.width() / view.reduction, height = depth_m.height() / view.reduction;
    Image<float> mean(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            mean(x, y) =
                MeanInverse(depth_m, x * view.reduction, y * view.reduction, view.reduction);
    Image<float> smooth(width, height, 0.0f);
    for (int y = 2; y < height - 2; ++y)
        for (int x = 2; x < width - 2; ++x) smooth(x, y) = Smoothed(mean, x, y);
    const PinholeCamera c = Averaged(camera, view.reduction);
    view.inverse_depth = Image<float>(width, height, 0.0f);
    view.normal = Image<Eigen::Vector3f>(width, height, Eigen::Vector3f::Zero());
    for (int y = 4; y < height - 4; ++y)
        for (int x = 4; x < width - 4; ++x) {
            const float middle = smooth(x, y), left = smooth(x - 2, y), right = smooth(x + 2, y),
                        above = smooth(x, y - 2), below = smooth(x, y + 2);
            if (std::min({middle, left, right, above, below}) <= 0) continue;
            const float bend = kBend * middle;
            if (std::abs(left + right - 2 * middle) > bend ||
                std::abs(above + below - 2 * middle) > bend)
                continue;
            // On a plane the inverse depth is linear in the ray's slopes: 1 / z = (a, b, c) . ray.
            const double a = (right - left) / 4 * c.fx, b = (below - above) / 4 * c.fy;
            const double rest = middle - a * (x - c.cx) / c.fx - b * (y - c.cy) / c.fy;
            view.inverse_depth(x, y) = middle;
            view.normal(x, y) = Eigen::Vector3d(a, b, rest).normalized().cast<float>();
        }
    return view;
}

}  // namespace tessera
