#include "optimize/features.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/features2d.hpp>

namespace tessera {
namespace {

// Median of the valid depths around a pixel. Corners often lie on object edges, where a single
// pixel may belong to either side.
float DepthAround(const DepthImage& depth, int x, int y) {
    std::vector<float> valid;
    valid.reserve(9);
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
            if (depth.Contains(x + dx, y + dy) && depth(x + dx, y + dy) > 0)
                valid.push_back(depth(x + dx, y + dy));
    if (valid.size() < 5) return 0;
    std::ranges::sort(valid);
    const bool edge = valid.back() - valid.front() > 0.05f * valid.front();
    return edge ? 0 : valid[valid.size() / 2];
}

}  // namespace

Features ExtractFeatures(const PreparedFrame& frame, const PinholeCamera& camera,
                         int max_features) {
    Features features;
    if (!frame.has_colour) return features;
    cv::Mat grey(frame.intensity.height(), frame.intensity.width(), CV_8U);
    for (std::size_t i = 0; i < frame.intensity.size(); ++i)
        grey.data[i] = static_cast<std::uint8_t>(
            std::lround(255 * std::clamp(frame.intensity.data()[i], 0.0f, 1.0f)));
    // Uses a low FAST threshold: only the strongest corners are kept anyway, and dim rooms have
    // few.
    constexpr float kScale = 1.2f;
    constexpr int kLevels = 8, kEdge_px = 19, kPatch_px = 31, kFastThreshold = 10;
    std::vector<cv::KeyPoint> points;
    cv::Mat descriptors;
    cv::ORB::create(max_features, kScale, kLevels, kEdge_px, 0, 2, cv::ORB::HARRIS_SCORE, kPatch_px,
                    kFastThreshold)
        ->detectAndCompute(grey, cv::noArray(), points, descriptors);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const cv::Point2f& p = points[i].pt;
        const float z = DepthAround(frame.depth_m, static_cast<int>(std::lround(p.x)),
                                    static_cast<int>(std::lround(p.y)));
        if (z <= 0) continue;
        std::memcpy(features.descriptors.emplace_back().data(),
                    descriptors.ptr(static_cast<int>(i)), sizeof(Descriptor));
        features.p_camera.push_back(camera.Unproject(p.x, p.y, z).cast<float>());
    }
    return features;
}

}  // namespace tessera
