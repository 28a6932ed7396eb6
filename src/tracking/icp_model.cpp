#include "tracking/icp_model.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera {
namespace {

void TakeView(const PredictedView& view, float jump_m, IcpModelLevel& level) {
    level.camera = view.camera;
    level.depth_m = view.depth_m;
    level.normal_camera = view.normal_camera;
    const int width = view.camera.width, height = view.camera.height;
    level.intensity.Resize(width, height);
    const auto jumps = [&](float here, float there) { return there <= 0 || std::abs(there - here) > jump_m; };
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x) {
            const float z = view.depth_m(x, y);
            const bool edge = z <= 0 || (x > 0 && jumps(z, view.depth_m(x - 1, y))) ||
                              (x + 1 < width && jumps(z, view.depth_m(x + 1, y))) ||
                              (y > 0 && jumps(z, view.depth_m(x, y - 1))) ||
                              (y + 1 < height && jumps(z, view.depth_m(x, y + 1)));
            level.intensity(x, y) = edge ? -1.0f : view.intensity(x, y);
        }
    });
}

void Halve(const IcpModelLevel& fine, float jump_m, IcpModelLevel& coarse) {
    PinholeCamera& c = coarse.camera;
    c = fine.camera;
    c.width /= 2;
    c.height /= 2;
    c.fx /= 2;
    c.fy /= 2;
    // Pixel i of the coarse level lies between the pixels 2 i and 2 i + 1 of the fine one.
    c.cx = (fine.camera.cx - 0.5) / 2;
    c.cy = (fine.camera.cy - 0.5) / 2;
    coarse.depth_m.Resize(c.width, c.height);
    coarse.normal_camera.Resize(c.width, c.height);
    coarse.intensity.Resize(c.width, c.height);
    tbb::parallel_for(0, c.height, [&](int y) {
        for (int x = 0; x < c.width; ++x) {
            const auto four = [&](const auto& image) {
                return std::array{image(2 * x, 2 * y), image(2 * x + 1, 2 * y), image(2 * x, 2 * y + 1),
                                  image(2 * x + 1, 2 * y + 1)};
            };
            const auto depth = four(fine.depth_m);
            const auto [nearest, farthest] = std::minmax_element(depth.begin(), depth.end());
            const bool surface = *nearest > 0 && *farthest - *nearest < jump_m;
            coarse.depth_m(x, y) = surface ? (depth[0] + depth[1] + depth[2] + depth[3]) / 4 : 0.0f;
            const auto normal = four(fine.normal_camera);
            coarse.normal_camera(x, y).setZero();
            if (surface) coarse.normal_camera(x, y) = (normal[0] + normal[1] + normal[2] + normal[3]).normalized();
            const auto value = four(fine.intensity);
            const bool coloured = surface && *std::min_element(value.begin(), value.end()) >= 0;
            coarse.intensity(x, y) = coloured ? (value[0] + value[1] + value[2] + value[3]) / 4 : -1.0f;
        }
    });
}

}  // namespace

void BuildIcpModel(const PredictedView& view, int count, float jump_m, std::vector<IcpModelLevel>& levels) {
    levels.resize(static_cast<std::size_t>(count));
    TakeView(view, jump_m, levels[0]);
    for (std::size_t i = 1; i < levels.size(); ++i) Halve(levels[i - 1], jump_m, levels[i]);
}

}  // namespace tessera
