#include "tracking/frame_points.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tracking/normal_equations.h"

namespace tessera {
namespace {

// One of the frame's images. Its pixels may be on a device only.
PinholeImage WithCamera(const Image<float>& image, const PreparedFrame& frame,
                        const PinholeCamera& camera) {
    return {image.data(),
            frame.width,
            frame.height,
            static_cast<float>(camera.fx),
            static_cast<float>(camera.fy),
            static_cast<float>(camera.cx),
            static_cast<float>(camera.cy)};
}

}  // namespace

int FinestStep(int configured, int at_vga_px, const PinholeCamera& camera) {
    const double pixels = static_cast<double>(camera.width) * camera.height;
    const int step_px =
        configured > 0
            ? configured
            : std::max(2,
                       static_cast<int>(std::lround(at_vga_px * std::sqrt(pixels / (640 * 480)))));
    return std::max(1, std::min(step_px, std::min(camera.width, camera.height) / 2));
}

int LevelsThatFit(int configured, int finest_step_px, const PinholeCamera& camera) {
    constexpr int kFewest = 6;  // pixels
    const int side = std::min(camera.width, camera.height) / finest_step_px;
    int levels = 1;
    while (levels < configured && side >> levels >= kFewest) ++levels;
    return levels;
}

PointArguments MakePointArguments(const PreparedFrame& frame, const PinholeCamera& camera,
                                  const FrameMotion& motion, int step, const DepthWeight& weight,
                                  bool intensities, bool chroma) {
    const auto sampled = [step](int pixels) { return (pixels + step - 1 - step / 2) / step; };
    PointArguments a{};
    a.depth = WithCamera(frame.depth_m, frame, camera);
    if (intensities && frame.has_colour) a.intensity = WithCamera(frame.intensity, frame, camera);
    a.chroma = intensities && chroma && frame.has_colour;
    if (a.chroma) a.packed_colour = frame.packed_colour.data();
    a.fx = camera.fx;
    a.fy = camera.fy;
    a.cx = camera.cx;
    a.cy = camera.cy;
    a.step = step;
    a.width = (sampled(frame.width) + kPointPadding - 1) / kPointPadding * kPointPadding;
    a.height = sampled(frame.height);
    a.noise_depth_m = static_cast<float>(weight.noise_depth_m);
    a.nearest_m = static_cast<float>(weight.nearest_m);
    a.normal_radius_px = -1;
    for (int i = 0; i < 6; ++i) a.twist_per_s[i] = static_cast<float>(motion.twist_per_s(i));
    a.still = motion.twist_per_s.isZero();
    a.depth_readout_s = motion.depth_readout_s;
    a.colour_delay_s = motion.colour_delay_s;
    a.colour_readout_s = motion.colour_readout_s;
    return a;
}

void FramePoints::Allocate(const PointArguments& a, std::int64_t valid) {
    step_ = a.step;
    width_ = a.width;
    height_ = a.height;
    valid_ = valid;
    for (auto* values : {&x, &y, &z, &weight, &intensity})
        values->resize(static_cast<std::size_t>(count()));
    for (auto* values : {&cb, &cr})
        values->resize(a.chroma ? static_cast<std::size_t>(count()) : 0);
}

void FramePoints::Build(const PointArguments& a) {
    BuildRows(a);
    if (a.normal_radius_px >= 0) EstimateNormals(a);
    if (a.intensity.width > 0) SampleColour(a);
}

void FramePoints::BuildRows(const PointArguments& a) {
    Allocate(a, 0);
    for (auto* values : {&x, &y, &z, &weight})
        values->assign(static_cast<std::size_t>(count()), 0.0f);
    intensity.assign(static_cast<std::size_t>(count()), -1.0f);
    std::vector<std::int64_t> valid(static_cast<std::size_t>(height_), 0);
    tbb::parallel_for(0, height_, [&](int row) {
        const PointRow r = RowOfPoints(a, row);
        const float* line = a.depth.pixels + static_cast<std::ptrdiff_t>(r.v) * a.depth.width;
        std::size_t at = static_cast<std::size_t>(row) * static_cast<std::size_t>(width_);
        for (int u = a.step / 2; u < a.depth.width; u += a.step, ++at) {
            const float d = line[u];
            if (d <= 0) continue;
            const CameraPoint p = PointOfPixel(a, r, u, d);
            x[at] = p.x;
            y[at] = p.y;
            z[at] = p.z;
            weight[at] = PointWeight(d, a.noise_depth_m, a.nearest_m);
            ++valid[static_cast<std::size_t>(row)];
        }
    });
    valid_ = std::accumulate(valid.begin(), valid.end(), std::int64_t{0});
}

void FramePoints::EstimateNormals(const PointArguments& a) {
    for (auto* values : {&normal_x, &normal_y, &normal_z})
        values->assign(static_cast<std::size_t>(count()), 0.0f);
    std::vector<std::int64_t> dropped(static_cast<std::size_t>(height_), 0);
    tbb::parallel_for(0, height_, [&](int row) {
        for (int column = 0; column < width_; ++column) {
            const std::size_t i = static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                                  static_cast<std::size_t>(column);
            if (weight[i] <= 0) continue;
            CameraPoint n;
            if (!NormalAt(a.depth, column * step_ + step_ / 2, ImageRow(row), a.normal_radius_px,
                          n)) {
                weight[i] = 0;
                ++dropped[static_cast<std::size_t>(row)];
                continue;
            }
            normal_x[i] = n.x;
            normal_y[i] = n.y;
            normal_z[i] = n.z;
        }
    });
    valid_ -= std::accumulate(dropped.begin(), dropped.end(), std::int64_t{0});
}

void FramePoints::SampleColour(const PointArguments& a) {
    for (auto* values : {&cb, &cr}) std::fill(values->begin(), values->end(), 0.0f);
    tbb::parallel_for(0, height_, [&](int row) {
        const PointRow r = RowOfPoints(a, row);
        std::size_t i = static_cast<std::size_t>(row) * static_cast<std::size_t>(width_);
        for (int column = 0; column < width_; ++column, ++i) {
            if (weight[i] <= 0) continue;
            const int u = column * step_ + step_ / 2;
            const CameraPoint p{x[i], y[i], z[i]};
            intensity[i] = IntensityOfPoint(a, r, u, p);
            if (!a.chroma || intensity[i] < 0) continue;
            const Chroma chroma = ChromaOfPoint(a, r, u, p);
            cb[i] = chroma.cb;
            cr[i] = chroma.cr;
        }
    });
}

}  // namespace tessera
