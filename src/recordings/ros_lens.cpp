#include "recordings/ros_lens.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "recordings/lens_fit.h"

namespace tessera {
namespace {

using Coefficients = std::array<double, 8>;

Eigen::Vector2d BrownConrady(const Coefficients& d, const Eigen::Vector2d& p) {
    const double x = p.x(), y = p.y(), r2 = x * x + y * y;
    const double radial =
        (1 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]))) / (1 + r2 * (d[5] + r2 * (d[6] + r2 * d[7])));
    return {x * radial + 2 * d[2] * x * y + d[3] * (r2 + 2 * x * x),
            y * radial + d[2] * (r2 + 2 * y * y) + 2 * d[3] * x * y};
}

// OpenCV's fisheye model.
Eigen::Vector2d Equidistant(const Coefficients& d, const Eigen::Vector2d& p) {
    const double r = p.norm();
    if (r < 1e-9) return p;
    const double a = std::atan(r), a2 = a * a;
    return p * (a * (1 + a2 * (d[0] + a2 * (d[1] + a2 * (d[2] + a2 * d[3])))) / r);
}

// The pixels of a grid over the image, as directions without distortion.
std::vector<Eigen::Vector2d> Grid(const RosCameraInfo& info) {
    constexpr int kSteps = 20;
    std::vector<Eigen::Vector2d> points;
    for (int j = 0; j <= kSteps; ++j)
        for (int i = 0; i <= kSteps; ++i)
            points.emplace_back((i * (info.width - 1.0) / kSteps - info.k[2]) / info.k[0],
                                (j * (info.height - 1.0) / kSteps - info.k[5]) / info.k[4]);
    return points;
}

RosLens Fitted(const RosCameraInfo& info, const Coefficients& d) {
    const bool inverse = info.distortion_model == "Inverse Brown Conrady";
    const bool fisheye = info.distortion_model == "equidistant";
    std::vector<LensPoint> points;
    for (const Eigen::Vector2d& p : Grid(info)) {
        const Eigen::Vector2d other = fisheye ? Equidistant(d, p) : BrownConrady(d, p);
        points.push_back(inverse ? LensPoint{other, p} : LensPoint{p, other});
    }
    const LensFit fit = FitLens(points, info.k[0]);
    constexpr double kGood_px = 0.5;
    RosLens lens{fit.lens, {}};
    if (!(fit.largest_px < kGood_px))
        lens.warning = fmt::format("the lens ({}) is only approximated: {:.1f} pixels at most",
                                   info.distortion_model, fit.largest_px);
    return lens;
}

}  // namespace

RosLens RosLensOf(const RosCameraInfo& info) {
    Coefficients d{};
    std::copy_n(info.distortion.begin(), std::min(info.distortion.size(), d.size()), d.begin());
    if (std::ranges::all_of(d, [](double value) { return value == 0; })) return {};
    const std::string_view model = info.distortion_model;
    const bool good = info.k[0] > 0 && info.k[4] > 0 &&
                      std::ranges::all_of(d, [](double value) { return std::isfinite(value); });
    if (good && (model == "plumb_bob" || model == "Brown Conrady"))
        return {{.k1 = d[0], .k2 = d[1], .p1 = d[2], .p2 = d[3], .k3 = d[4]}, {}};
    if (good && (model == "rational_polynomial" || model == "equidistant" ||
                 model == "Modified Brown Conrady" || model == "Inverse Brown Conrady"))
        return Fitted(info, d);
    return {{}, fmt::format("the lens model {} is not known: its distortion stays", model)};
}

}  // namespace tessera
