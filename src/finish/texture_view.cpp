#include "finish/texture_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "core/depth_noise.h"
#include "core/quantile.h"
#include "finish/path_motion.h"

namespace tessera {
namespace {

using Eigen::Array3f;
using Eigen::Vector2f;
using Eigen::Vector3f;

// How far a point of the map may be from a frame's depth, besides that noise.
constexpr float kMap_m = 0.01f;
constexpr float kLeastCosine = 0.2f;
constexpr float kLeastTrust = 0.03f;  // of what no view shows far from an edge
constexpr float kSaturated = 250;
constexpr float kFar_px = 7;  // from an edge: full trust

constexpr float kMoves_m = 0.2f;  // at most, while the rows are read

float Margin_m(float z_m) { return kMap_m + 3 * DepthSigma_m(z_m); }

bool Jumps(float a, float b) { return a <= 0 || b <= 0 || std::abs(a - b) > 0.03f + 0.02f * a; }

// 0 to 1: the distance in pixels (of steps to the 8 neighbours) from pixels at a jump, of kFar_px.
Image<float> TrustOf(const DepthImage& depth) {
    const int width = depth.width(), height = depth.height();
    cv::Mat calm(height, width, CV_8U), far_px;
    for (int y = 0; y < height; ++y) {
        const float* const row = depth.row(y);
        const float* const below = depth.row(std::min(y + 1, height - 1));
        auto* const out = calm.ptr<std::uint8_t>(y);
        for (int x = 0; x < width; ++x)
            out[x] = row[x] > 0 && !Jumps(row[x], row[std::min(x + 1, width - 1)]) &&
                     !Jumps(row[x], below[x]);
    }
    cv::distanceTransform(calm, far_px, cv::DIST_C, 3);
    Image<float> trust(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            trust(x, y) = std::clamp(far_px.at<float>(y, x) / kFar_px, kLeastTrust, 1.0f);
    return trust;
}

// Of a point in the camera's frame; nullopt where it is not well within the image.
inline std::optional<Vector2f> PixelOf(const TextureView& view, const Vector3f& p_camera) {
    if (p_camera.z() < 0.1f) return std::nullopt;
    const float per_z = 1 / p_camera.z();
    const Vector2f at(view.fx * p_camera.x() * per_z + view.cx,
                      view.fy * p_camera.y() * per_z + view.cy);
    if (!(at.x() >= 1 && at.y() >= 1 && at.x() < static_cast<float>(view.camera.width - 2) &&
          at.y() < static_cast<float>(view.camera.height - 2)))
        return std::nullopt;
    return at;
}

// Per channel, the colours of every step-th vertex over those that the view shows of them.
std::array<std::vector<float>, 3> RatiosOf(const TriangleMesh& mesh, std::size_t step,
                                           const TextureView& view) {
    std::array<std::vector<float>, 3> ratios;
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
    return ratios;
}

}  // namespace

TextureView MakeTextureView(const PinholeCamera& camera, const Frame& frame,
                            const FrameMotion& motion) {
    TextureView view;
    view.camera = camera;
    view.fx = static_cast<float>(camera.fx);
    view.fy = static_cast<float>(camera.fy);
    view.cx = static_cast<float>(camera.cx);
    view.cy = static_cast<float>(camera.cy);
    view.T_camera_world = frame.T_world_camera->inverse().cast<float>();
    view.centre_world = frame.T_world_camera->translation().cast<float>();
    view.turning_per_s = motion.twist_per_s.head<3>().cast<float>();
    view.moving_per_s = motion.twist_per_s.tail<3>().cast<float>();
    view.depth_readout_s = static_cast<float>(motion.depth_readout_s);
    view.colour_delay_s = static_cast<float>(motion.colour_delay_s);
    view.colour_readout_s = static_cast<float>(motion.colour_readout_s);
    view.colour = frame.colour;
    view.depth_m = frame.depth_m;
    for (const float depth_m : std::span(view.depth_m.data(), view.depth_m.size()))
        view.farthest_m = std::max(view.farthest_m, depth_m);
    view.farthest_m += 2 * Margin_m(view.farthest_m) + kMoves_m;
    view.trust = TrustOf(frame.depth_m);
    view.blur_px = MotionBlur_px(motion.twist_per_s, camera);
    return view;
}

SeenColour See(const TextureView& view, const Vector3f& p_world, const Vector3f& n_world) {
    SeenColour seen;
    const Vector3f ray = p_world - view.centre_world;
    const float away = ray.dot(n_world);
    if (away >= 0 || away * away < kLeastCosine * kLeastCosine * ray.squaredNorm()) return seen;
    const Vector3f p = view.T_camera_world * p_world;
    const std::optional<Vector2f> at = PixelOf(view, p);
    if (!at) return seen;
    // Where the moving camera had the point when it read the row.
    const Vector3f velocity = view.turning_per_s.cross(p) + view.moving_per_s;
    const float row = at->y() / static_cast<float>(view.camera.height) - 0.5f;
    const Vector3f p_depth = p - row * view.depth_readout_s * velocity;
    const std::optional<Vector2f> depth_at = PixelOf(view, p_depth);
    if (!depth_at) return seen;
    const int near_x = static_cast<int>(depth_at->x() + 0.5f),
              near_y = static_cast<int>(depth_at->y() + 0.5f);
    const float z = p_depth.z(), measured = view.depth_m(near_x, near_y);
    if (measured <= 0 || std::abs(measured - z) > Margin_m(z)) return seen;
    const std::optional<Vector2f> colour_at =
        PixelOf(view, p - (view.colour_delay_s + row * view.colour_readout_s) * velocity);
    if (!colour_at) return seen;
    const int x = static_cast<int>(colour_at->x()), y = static_cast<int>(colour_at->y());
    const float fx = colour_at->x() - static_cast<float>(x),
                fy = colour_at->y() - static_cast<float>(y);
    const Rgb8 *top = view.colour.row(y) + x, *bottom = view.colour.row(y + 1) + x;
    seen.rgb = (1 - fy) * ((1 - fx) * ToArray(top[0]) + fx * ToArray(top[1])) +
               fy * ((1 - fx) * ToArray(bottom[0]) + fx * ToArray(bottom[1]));
    const float trust =
        view.trust(near_x, near_y) * (seen.rgb.maxCoeff() < kSaturated ? 1.0f : 0.1f);
    const float facing2 = away * away / ray.squaredNorm();
    const float quality = facing2 / (z * z * (1 + view.blur_px)) * trust;
    seen.weight = quality * quality * quality;
    return seen;
}

void EstimateGain(const TriangleMesh& mesh, TextureView& view) {
    constexpr std::size_t kSamples = 20000, kLeast = 100;
    view.gain.setOnes();
    std::size_t step = mesh.vertices.size() / kSamples + 1;
    std::array<std::vector<float>, 3> ratios = RatiosOf(mesh, step, view);
    // A view of a small part of a large mesh shows few of them.
    while (ratios[0].size() < kLeast && step > 1) {
        step = std::max<std::size_t>(step / 4, 1);
        ratios = RatiosOf(mesh, step, view);
    }
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
