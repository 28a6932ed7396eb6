// Simulates a Kinect-like camera on an ideal view: structured-light depth with noise and holes,
// colour with noise, vignetting and drifting exposure. Every random number is a function of (seed,
// frame, pixel), so the result does not depend on the number of threads. Thread-safe.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/config.h"
#include "core/image.h"
#include "synth/frame_renderer.h"

namespace tessera {

enum class NoiseModel { kNone, kKinect };

class SensorModel {
  public:
    struct Config {
        NoiseModel noise = NoiseModel::kNone;  // kNone: everything below is off

        double focal_px = 580;      // of the depth sensor; disparity = focal * baseline / z
        double baseline_m = 0.075;  // the projector is to the left of the camera
        double disparity_std_px = 0.05;
        double correlation_px = 6;  // Gaussian sigma of the spatial correlation
        double disparity_step_px = 0.125;
        double min_depth_m = 0.45, max_depth_m = 5;
        double min_cos = 0.2;         // surfaces at more grazing angles have no depth
        double lateral_std_px = 0.5;  // jitter of depth discontinuities
        double edge_dropout = 0.5;    // probability of no depth at a discontinuity
        bool shadow = true;           // no depth where the projector is occluded

        double exposure_s = 0.008;     // motion blur
        double colour_noise = 1.0;     // grey levels in dark areas; 0.6 times that in bright areas
        double vignetting = 0.10;      // share of brightness lost in the corners
        double exposure_drift = 0.05;  // the gain drifts by at most this share, within seconds

        void Describe(ConfigParameters& parameters);
    };

    SensorModel(const Config& config, const PinholeCamera& camera, std::uint64_t seed);

    const Config& config() const { return config_; }
    // Exposure time for rendering, seconds.
    double exposure_s() const {
        return config_.noise == NoiseModel::kNone ? 0.0 : config_.exposure_s;
    }

    // Metres along the optical axis, 0 = no measurement.
    void SenseDepth(const RenderedView& view, std::int64_t frame, DepthImage& depth_m) const;
    void SenseColour(const RenderedView& view, std::int64_t frame, double time_s,
                     ColourImage& colour) const;

    // Gain of the colour image at a time, 1 +- exposure_drift.
    double Gain(double time_s) const;

  private:
    void SenseDepthRow(const RenderedView& view, std::int64_t frame, int y, float* depth_m) const;

    Config config_;
    PinholeCamera camera_;
    std::uint64_t seed_;
};

// A smooth random image with mean 0 and standard deviation 1 at every pixel. Correlated as if white
// noise had been blurred by a Gaussian of `sigma_px`; implemented as a cubic B-spline with random
// coefficients.
class SmoothNoise {
  public:
    SmoothNoise(std::uint64_t key, double sigma_px, int width);
    // Writes the values of row y to out[0 .. width).
    void Row(int y, std::vector<float>& out) const;

  private:
    std::uint64_t key_;
    double spacing_px_;
    int width_;
};

}  // namespace tessera
