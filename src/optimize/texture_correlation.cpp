#include "optimize/texture_correlation.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace tessera {
namespace {

constexpr float kNone = 2;  // no texture here; no difference of intensities is so large

cv::Mat View(const Image<float>& image) {
    return {image.height(), image.width(), CV_32F, const_cast<float*>(image.data())};
}

// Intensity less the mean of the pixels around it that have one.
Image<float> FineTexture(const Image<float>& intensity) {
    constexpr int kSide_px = 9;
    const cv::Mat image = View(intensity), valid = image >= 0;
    cv::Mat present, values, count, sum;
    valid.convertTo(present, CV_32F, 1.0 / 255);
    values = image.mul(present);
    const cv::Size window(kSide_px, kSide_px);
    cv::boxFilter(present, count, -1, window, {-1, -1}, false, cv::BORDER_CONSTANT);
    cv::boxFilter(values, sum, -1, window, {-1, -1}, false, cv::BORDER_CONSTANT);
    Image<float> fine(intensity.width(), intensity.height());
    for (int y = 0; y < fine.height(); ++y)
        for (int x = 0; x < fine.width(); ++x)
            fine(x, y) = intensity(x, y) < 0
                             ? kNone
                             : intensity(x, y) - sum.at<float>(y, x) / count.at<float>(y, x);
    return fine;
}

struct Moments {
    double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    int count = 0;

    void Add(double in_a, double in_b) {
        a += in_a, b += in_b;
        aa += in_a * in_a, bb += in_b * in_b, ab += in_a * in_b;
        ++count;
    }
    double Correlation() const {
        const double variance_a = aa - a * a / count, variance_b = bb - b * b / count;
        return variance_a > 0 && variance_b > 0
                   ? (ab - a * b / count) / std::sqrt(variance_a * variance_b)
                   : 0;
    }
};

}  // namespace

double TextureCorrelation(const DenseView& a, const DenseView& b, const Eigen::Isometry3d& T_a_b) {
    constexpr double kSameSurface = 0.05;  // of the depth
    constexpr int kFewest = 200;
    const DenseView::Level &in_a = a.levels.back(), &in_b = b.levels.back();
    const Image<float> texture_a = FineTexture(in_a.intensity),
                       texture_b = FineTexture(in_b.intensity);
    Moments moments;
    for (int y = 0; y < texture_b.height(); ++y)
        for (int x = 0; x < texture_b.width(); ++x) {
            const float z = in_b.depth_m(x, y);
            if (z <= 0 || texture_b(x, y) == kNone) continue;
            const Eigen::Vector3d p = T_a_b * in_b.camera.Unproject(x, y, z);
            if (p.z() < 0.1) continue;
            const Eigen::Vector2d pixel = in_a.camera.Project(p);
            if (!(pixel.x() > -0.5 && pixel.y() > -0.5 && pixel.x() < texture_a.width() - 0.5 &&
                  pixel.y() < texture_a.height() - 0.5))
                continue;
            const int u = static_cast<int>(std::lround(pixel.x())),
                      v = static_cast<int>(std::lround(pixel.y()));
            const float there = in_a.depth_m(u, v);
            if (there <= 0 || std::abs(there - p.z()) > kSameSurface * p.z() ||
                texture_a(u, v) == kNone)
                continue;
            moments.Add(texture_a(u, v), texture_b(x, y));
        }
    return moments.count < kFewest ? 0 : moments.Correlation();
}

}  // namespace tessera
