#include "io/rectifier.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace tessera {
namespace {

// For each pixel of the ideal image, the nearest pixel of the raw image.
std::vector<std::int32_t> NearestPixels(const cv::Mat& x, const cv::Mat& y) {
    std::vector<std::int32_t> source;
    source.reserve(x.total());
    for (int v = 0; v < x.rows; ++v)
        for (int u = 0; u < x.cols; ++u) {
            const float column = std::round(x.at<float>(v, u)), row = std::round(y.at<float>(v, u));
            const bool inside = column >= 0 && row >= 0 && column < static_cast<float>(x.cols) &&
                                row < static_cast<float>(x.rows);
            source.push_back(inside ? static_cast<int>(row) * x.cols + static_cast<int>(column)
                                    : -1);
        }
    return source;
}

}  // namespace

struct Rectifier::ColourMaps {
    // OpenCV's fixed-point form: integer pixel, and index of its bilinear weights.
    cv::Mat whole, fraction;
};

Rectifier::Rectifier(const CameraCalibration& calibration, const Options& options)
    : calibration_(calibration), invalid_depth_(options.invalid_depth) {
    if (calibration.colour) {
        ColourCamera colour = *calibration.colour;
        if (!options.correct_distortion) colour.distortion = {};
        corrects_lens_ = !colour.distortion.IsZero();
        registration_.emplace(colour, calibration.pinhole);
    }
    const ImageSize raw = colour_size();
    brightening_.emplace(raw.width, raw.height, calibration.vignetting);
    const LensDistortion& d = calibration.distortion;
    if (d.IsZero() || !options.correct_distortion) return;
    corrects_lens_ = true;
    const PinholeCamera& p = calibration.pinhole;
    const cv::Matx33d intrinsics(p.fx, 0, p.cx, 0, p.fy, p.cy, 0, 0, 1);
    const cv::Vec<double, 5> coefficients(d.k1, d.k2, d.p1, d.p2, d.k3);
    cv::Mat x, y;
    cv::initUndistortRectifyMap(intrinsics, coefficients, cv::noArray(), intrinsics,
                                cv::Size(p.width, p.height), CV_32FC1, x, y);
    depth_source_ = NearestPixels(x, y);
    colour_maps_ = std::make_unique<ColourMaps>();
    cv::convertMaps(x, y, colour_maps_->whole, colour_maps_->fraction, CV_16SC2);
}

Rectifier::~Rectifier() = default;
Rectifier::Rectifier(Rectifier&&) noexcept = default;
Rectifier& Rectifier::operator=(Rectifier&&) noexcept = default;

ImageSize Rectifier::colour_size() const {
    return registration_ ? registration_->raw_size()
                         : ImageSize{calibration_.pinhole.width, calibration_.pinhole.height};
}

void Rectifier::Colour(const ColourImage& raw, ColourImage& rectified) const {
    const PinholeCamera& p = calibration_.pinhole;
    TESSERA_CHECK(raw.width() == p.width && raw.height() == p.height, "{} x {}", raw.width(),
                  raw.height());
    TESSERA_CHECK(!registration_, "colour of an unregistered camera needs its depth");
    if (!active()) {
        rectified = raw;
        return;
    }
    rectified.Resize(p.width, p.height);
    const cv::Mat from(p.height, p.width, CV_8UC3, const_cast<Rgb8*>(raw.data()));  // only read
    cv::Mat to(p.height, p.width, CV_8UC3, rectified.data());
    cv::remap(from, to, colour_maps_->whole, colour_maps_->fraction, cv::INTER_LINEAR,
              cv::BORDER_REPLICATE);
}

void Rectifier::Depth(const Image<std::uint16_t>& raw, DepthImage& depth_m) const {
    const PinholeCamera& p = calibration_.pinhole;
    TESSERA_CHECK(raw.width() == p.width && raw.height() == p.height, "{} x {}", raw.width(),
                  raw.height());
    depth_m.Resize(p.width, p.height);
    const auto units_per_metre = static_cast<float>(calibration_.depth_scale);
    const std::uint16_t* from = raw.data();
    float* to = depth_m.data();
    const auto metres = [&](std::uint16_t stored) {
        return stored == invalid_depth_ ? 0.0f : static_cast<float>(stored) / units_per_metre;
    };
    if (depth_source_.empty()) {
        for (std::size_t i = 0; i < raw.size(); ++i) to[i] = metres(from[i]);
        return;
    }
    const std::int32_t* source = depth_source_.data();
    for (std::size_t i = 0; i < depth_source_.size(); ++i)
        to[i] = source[i] < 0 ? 0.0f : metres(from[source[i]]);
}

void Rectifier::Fill(const Image<std::uint16_t>& raw_depth, ColourImage& raw_colour, Frame& frame) {
    Depth(raw_depth, frame.depth_m);
    brightening_->Apply(raw_colour);
    if (registration_ && raw_colour.size() > 0)
        registration_->Register(raw_colour, frame.depth_m, frame.colour);
    else if (active() && raw_colour.size() > 0)
        Colour(raw_colour, frame.colour);
    else
        std::swap(frame.colour, raw_colour);
}

}  // namespace tessera
