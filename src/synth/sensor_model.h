// What a Kinect-like camera makes of an ideal view: structured-light depth with its noise and
// holes, colour with noise, vignetting and a wandering exposure. Every random number is a function
// of (seed, frame, pixel), so the result is the same for any number of threads. Thread-safe.
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
        NoiseModel noise = NoiseModel::kNone;  // kNone: all of the below is off

        double focal_px = 580;      // of the depth sensor, for disparity = focal * baseline / z
        double baseline_m = 0.075;  // projector to the left of the camera
        double disparity_std_px = 0.05;
        double correlation_px = 6;  // Gaussian sigma of the noise's extent in the image
        double disparity_step_px = 0.125;
        double min_depth_m = 0.45, max_depth_m = 5;
        double min_cos = 0.2;         // flatter surfaces give no depth
        double lateral_std_px = 0.5;  // raggedness of depth edges
        double edge_dropout = 0.5;    // probability of no depth at an edge
        bool shadow = true;           // no depth where the projector does not reach

        double exposure_s = 0.008;     // motion blur
        double colour_noise = 1.0;     // grey levels in the dark; 0.6 of it in bright parts
        double vignetting = 0.10;      // darker by this share in the corners
        double exposure_drift = 0.05;  // gain wanders by at most this share, within seconds

        void Describe(ConfigParameters& parameters);
    };

    SensorModel(const Config& config, const PinholeCamera& camera, std::uint64_t seed);

    const Config& config() const { return config_; }
    // Exposure time to render with, seconds.
    double exposure_s() const {
        return config_.noise == NoiseModel::kNone ? 0.0 : config_.exposure_s;
    }

    // Metres along the optical axis, 0 = no measurement.
    void SenseDepth(const RenderedView& view, std::int64_t frame, DepthImage& depth_m) const;
    void SenseColour(const RenderedView& view, std::int64_t frame, double time_s,
                     ColourImage& colour) const;

    // The colour's gain at a time, 1 +- exposure_drift.
    double Gain(double time_s) const;

  private:
    void SenseDepthRow(const RenderedView& view, std::int64_t frame, int y, float* depth_m) const;

    Config config_;
    PinholeCamera camera_;
    std::uint64_t seed_;
};

// A smooth random image of mean 0 and standard deviation 1 at every pixel, correlated over
// `sigma_px` as if white noise had been blurred by such a Gaussian: a cubic B-spline over random
// coefficients.
class SmoothNoise {
  public:
    SmoothNoise(std::uint64_t key, double sigma_px, int width);
    // Values of row y into out[0 .. width).
    void Row(int y, std::vector<float>& out) const;

  private:
    std::uint64_t key_;
    double spacing_px_;
    int width_;
};

}  // namespace tessera
