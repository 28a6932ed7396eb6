#include "synth/sensor_model.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "synth/hash_random.h"

namespace tessera {
namespace {

constexpr std::uint64_t kColourStream = 3, kDriftStream = 4;

std::uint8_t Quantise(float grey) {
    return static_cast<std::uint8_t>(std::clamp(grey + 0.5f, 0.0f, 255.0f));
}

}  // namespace

void SensorModel::Config::Describe(ConfigParameters& p) {
    p.AddChoice("noise", noise, {{"none", NoiseModel::kNone}, {"kinect", NoiseModel::kKinect}},
                "none: ideal camera; kinect: all effects of this section");
    p.Add("focal_px", focal_px, {50, 5000}, "px",
          "focal length of the depth sensor; disparity = focal_px * baseline_m / z");
    p.Add("baseline_m", baseline_m, {0.005, 1}, "m", "distance between projector and depth camera");
    p.Add("disparity_std_px", disparity_std_px, {0, 2}, "px",
          "standard deviation of the disparity noise; the depth noise grows with z^2");
    p.Add("correlation_px", correlation_px, {0.5, 50}, "px",
          "correlation length of the disparity noise in the image");
    p.Add("disparity_step_px", disparity_step_px, {0, 2}, "px",
          "quantisation of the disparity, 0 = none");
    p.Add("min_depth_m", min_depth_m, {0, 100}, "m", "surfaces nearer than this have no depth");
    p.Add("max_depth_m", max_depth_m, {0.1, 1000}, "m", "surfaces farther than this have no depth");
    p.Add(
        "min_cos", min_cos, {0, 1}, "",
        "surfaces at more grazing angles (smaller cosine of the angle of incidence) have no depth");
    p.Add("lateral_std_px", lateral_std_px, {0, 3}, "px",
          "lateral jitter of depth discontinuities");
    p.Add("edge_dropout", edge_dropout, {0, 1}, "",
          "probability that a pixel at a depth discontinuity has no depth");
    p.Add("shadow", shadow, "no depth where the projector is occluded");
    p.Add("exposure_s", exposure_s, {0, 0.1}, "s", "exposure time, causes motion blur");
    p.Add("colour_noise", colour_noise, {0, 50}, "grey levels",
          "standard deviation of the noise in dark areas; 0.6 times that in bright areas");
    p.Add("vignetting", vignetting, {0, 0.9}, "", "share of brightness lost in the image corners");
    p.Add("exposure_drift", exposure_drift, {0, 0.5}, "",
          "largest relative change of the gain over time");
}

SensorModel::SensorModel(const Config& config, const PinholeCamera& camera, std::uint64_t seed)
    : config_(config), camera_(camera), seed_(seed) {}

double SensorModel::Gain(double time_s) const {
    if (config_.noise == NoiseModel::kNone) return 1.0;
    const double full = 2 * std::numbers::pi;
    const double phase_a = full * UniformFromBits(StreamKey(seed_, kDriftStream, 0));
    const double phase_b = full * UniformFromBits(StreamKey(seed_, kDriftStream, 1));
    return 1 + config_.exposure_drift * (0.6 * std::sin(full * 0.13 * time_s + phase_a) +
                                         0.4 * std::sin(full * 0.31 * time_s + phase_b));
}

void SensorModel::SenseColour(const RenderedView& view, std::int64_t frame, double time_s,
                              ColourImage& colour) const {
    const int width = view.colour.width(), height = view.colour.height();
    colour.Resize(width, height);
    const bool ideal = config_.noise == NoiseModel::kNone;
    const auto gain = static_cast<float>(Gain(time_s));
    const auto vignetting = static_cast<float>(ideal ? 0.0 : config_.vignetting);
    const auto noise = static_cast<float>(ideal ? 0.0 : config_.colour_noise);
    const std::uint64_t key = StreamKey(seed_, kColourStream, static_cast<std::uint64_t>(frame));
    const float centre_x = 0.5f * static_cast<float>(width - 1),
                centre_y = 0.5f * static_cast<float>(height - 1);
    const float corner2 = std::max(centre_x * centre_x + centre_y * centre_y, 1.0f);
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x) {
            const float dx = static_cast<float>(x) - centre_x,
                        dy = static_cast<float>(y) - centre_y;
            const float scale = gain * (1 - vignetting * (dx * dx + dy * dy) / corner2);
            const RgbF in = view.colour(x, y);
            float channels[3] = {in.r * scale, in.g * scale, in.b * scale};
            if (noise > 0) {
                std::uint64_t counter = 3 * (static_cast<std::uint64_t>(y) * width + x);
                for (float& c : channels)
                    c += noise * (1.0f - 0.4f * std::min(c, 255.0f) / 255.0f) *
                         GaussianFromBits(MixBits(key + counter++));
            }
            colour(x, y) = {Quantise(channels[0]), Quantise(channels[1]), Quantise(channels[2])};
        }
    });
}

}  // namespace tessera
