#include "finish/texture_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "core/depth_noise.h"
#include "core/quantile.h"

namespace tessera {
namespace {

using Eigen::Array3f;
using Eigen::Vector3f;

// How far a point of the map may be from a frame's depth, besides that noise.
constexpr float kMap_m = 0.01f;
constexpr float kLeastCosine = 0.2f;
constexpr float kLeastTrust = 0.03f;  // of what no view shows far from an edge
constexpr float kSaturated = 250;
constexpr float kFar_px = 7;  // from an edge: full trust

bool Jumps(float a, float b) { return a <= 0 || b <= 0 || std::abs(a - b) > 0.03f + 0.02f * a; }

// Distance in pixels (of steps to the 8 neighbours), at most kFar_px, from pixels at a jump.
Image<float> FromEdges(const DepthImage& depth) {
    const int width = depth.width(), height = depth.height();
    Image<float> far(width, height, kFar_px);
    const auto edge = [&](int x, int y, int dx, int dy) {
        return Jumps(depth(x, y), depth(x + dx, y + dy));
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (depth(x, y) <= 0 || (x + 1 < width && edge(x, y, 1, 0)) ||
                (y + 1 < height && edge(x, y, 0, 1)))
                far(x, y) = 0;
    const auto relax = [&](int x, int y, int dx, int dy) {
        if (far.Contains(x + dx, y + dy)) far(x, y) = std::min(far(x, y), far(x + dx, y + dy) + 1);
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const auto& [dx, dy] : {std::array{-1, 0}, {-1, -1}, {0, -1}, {1, -1}})
                relax(x, y, dx, dy);
    for (int y = height - 1; y >= 0; --y)
        for (int x = width - 1; x >= 0; --x)
            for (const auto& [dx, dy] : {std::array{1, 0}, {1, 1}, {0, 1}, {-1, 1}})
                relax(x, y, dx, dy);
    return far;
}

}  // namespace

TextureView MakeTextureView(const PinholeCamera& camera, const Frame& frame) {
    TextureView view;
    view.camera = camera;
    view.T_camera_world = frame.T_world_camera->inverse().cast<float>();
    view.colour = frame.colour;
    view.depth_m = frame.depth_m;
    view.trust = FromEdges(frame.depth_m);
    for (float& t : std::span(view.trust.data(), view.trust.size()))
        t = std::max(t / kFar_px, kLeastTrust);
    return view;
}

SeenColour See(const TextureView& view, const Vector3f& p_world, const Vector3f& n_world) {
    SeenColour seen;
    const Vector3f p = view.T_camera_world * p_world;
    const float z = p.z();
    if (z < 0.1f) return seen;
    const PinholeCamera& camera = view.camera;
    const float u = p.x() / z * static_cast<float>(camera.fx) + static_cast<float>(camera.cx);
    const float v = p.y() / z * static_cast<float>(camera.fy) + static_cast<float>(camera.cy);
    if (!(u >= 1 && v >= 1 && u < static_cast<float>(camera.width - 2) &&
          v < static_cast<float>(camera.height - 2)))
        return seen;
    const float facing = -(view.T_camera_world.linear() * n_world).dot(p) / p.norm();
    if (facing < kLeastCosine) return seen;
    const int x = static_cast<int>(u), y = static_cast<int>(v);
    const int near_x = static_cast<int>(u + 0.5f), near_y = static_cast<int>(v + 0.5f);
    const float measured = view.depth_m(near_x, near_y);
    if (measured <= 0 || std::abs(measured - z) > kMap_m + 3 * DepthSigma_m(z)) return seen;
    const float fx = u - static_cast<float>(x), fy = v - static_cast<float>(y);
    const Rgb8 *top = view.colour.row(y) + x, *bottom = view.colour.row(y + 1) + x;
    seen.rgb = (1 - fy) * ((1 - fx) * ToArray(top[0]) + fx * ToArray(top[1])) +
               fy * ((1 - fx) * ToArray(bottom[0]) + fx * ToArray(bottom[1]));
    const float trust =
        view.trust(near_x, near_y) * (seen.rgb.maxCoeff() < kSaturated ? 1.0f : 0.1f);
    const float quality = facing * facing / (z * z * (1 + view.blur_px)) * trust;
    seen.weight = quality * quality * quality;
    return seen;
}

float MotionBlur_px(std::span<const StampedPose> path, double stamp_s,
                    const PinholeCamera& camera) {
    constexpr double kExposure_s = 1.0 / 60, kLongest_s = 0.2;
    const auto after = std::ranges::upper_bound(path, stamp_s, {}, &StampedPose::stamp_s);
    auto before = std::ranges::lower_bound(path, stamp_s, {}, &StampedPose::stamp_s);
    if (after == path.end() || before == path.begin()) return 0;
    --before;
    const double time_s = after->stamp_s - before->stamp_s;
    if (time_s > kLongest_s) return 0;
    const double turn_rad = RotationAngle(before->T_world_camera, after->T_world_camera);
    return static_cast<float>(turn_rad / time_s * kExposure_s * camera.fx);
}

void EstimateGain(const TriangleMesh& mesh, TextureView& view) {
    constexpr std::size_t kSamples = 20000, kLeast = 100;
    std::array<std::vector<float>, 3> ratios;
    const std::size_t step = mesh.vertices.size() / kSamples + 1;
    for (std::size_t i = 0; i < mesh.vertices.size(); i += step) {
        const SeenColour seen = See(view, mesh.vertices[i], mesh.normals[i]);
        const Array3f model = ToArray(mesh.colours[i]);
        // What is dark or saturated says nothing about the gain.
        if (seen.weight <= 0 || seen.rgb.minCoeff() < 20 || seen.rgb.maxCoeff() > 245 ||
            model.minCoeff() < 20 || model.maxCoeff() > 245)
            continue;
        for (std::size_t c = 0; c < 3; ++c) {
            const auto k = static_cast<Eigen::Index>(c);
            ratios[c].push_back(model[k] / seen.rgb[k]);
        }
    }
    view.gain.setOnes();
    if (ratios[0].size() < kLeast) return;
    for (std::size_t c = 0; c < 3; ++c) view.gain[static_cast<Eigen::Index>(c)] = Median(ratios[c]);
}

double Sharpness(const ColourImage& image) {
    const auto luma = [](const Rgb8& c) { return 77 * c.r + 150 * c.g + 29 * c.b; };
    std::int64_t sum = 0, count = 0;
    for (int y = 0; y + 1 < image.height(); y += 2) {
        const Rgb8 *row = image.row(y), *next = image.row(y + 1);
        for (int x = 0; x + 1 < image.width(); ++x, ++count)
            sum +=
                std::abs(luma(row[x + 1]) - luma(row[x])) + std::abs(luma(next[x]) - luma(row[x]));
    }
    return count > 0 ? static_cast<double>(sum) / (256.0 * static_cast<double>(count)) : 0;
}

}  // namespace tessera
