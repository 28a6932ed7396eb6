// Tracks a frame directly in the signed distance field by Gauss-Newton on distances and intensities ([B14] eq. 8-11;
// alpha = 0 gives [B13]), coarse to fine over subsampled points.
#pragma once

#include <vector>

#include "core/cpu.h"
#include "tracking/sdf_points.h"
#include "tracking/sdf_rows.h"
#include "tracking/sdf_solver.h"
#include "tracking/shutter_estimator.h"
#include "tracking/tracker.h"

namespace tessera {

class SdfTracker : public Tracker {
  public:
    enum class AlphaMode { kFixed, kAuto };

    struct Config {
        AlphaMode alpha_mode = AlphaMode::kAuto;
        double alpha = 0.1;
        double auto_alpha_min = 0.01;
        double auto_alpha_max = 0.25;
        double distance_scale_m = 0.02;
        double intensity_scale = 0.1;
        double depth_exponent = 2.0;
        bool normalise = true;
        int finest_step_px = 2;
        int levels = 3;
        int coarse_iterations = 20;
        int fine_iterations = 6;
        bool brightness = true;
        double brightness_prior = 0.05;
        double min_eigenvalue = 1e-4;
        double min_known_fraction = 0.1;
        double min_inlier_fraction = 0.2;
        double good_inlier_fraction = 0.35;
        double max_jump_m = 0.3;
        double max_jump_rad = 0.5;
        ShutterEstimator::Config shutter;

        void Describe(ConfigParameters& parameters);
    };

    SdfTracker(const Config& config, const PinholeCamera& camera, VectorPath path = VectorPath::kAuto);

    TrackResult Track(const TrackInput& input) override;
    void Reset() override;

  private:
    struct State;  // of one call

    void PrepareLevel(const TrackInput& input, int level, State& state);
    void ChooseStart(const TrackInput& input, State& state);
    void RunLevel(const TrackInput& input, int level, State& state);
    SdfSums SumAt(const TrackInput& input, const SdfPoints& points, State& state) const;
    SdfSums Sum(const SdfArguments& arguments, const SdfPoints& points) const;
    void Judge(const TrackInput& input, const SdfSums& sums, const SdfStep& step, TrackResult& result) const;
    void Learn(const TrackInput& input, const State& state, const TrackResult& result);
    void UpdateAlpha(const SdfPoints& points);

    Config config_;
    PinholeCamera camera_;
    bool use_avx2_;
    double alpha_;          // in use
    double gain_ = 1, offset_ = 0;  // of the last good frame
    double distance_variance_ = 0, intensity_variance_ = 0;  // of tile means, smoothed over frames
    ShutterEstimator shutter_;
    std::vector<SdfPoints> points_;  // per level
    std::vector<float> distance_residual_, intensity_residual_;
};

}  // namespace tessera
