// Tracks a frame directly in the signed distance field by Gauss-Newton on distances and intensities
// ([B14] eq. 8-11; alpha = 0 gives [B13]), coarse to fine over subsampled points.
#pragma once

#include <vector>

#include "core/cpu.h"
#include "tracking/conclude.h"
#include "tracking/frame_points.h"
#include "tracking/sdf_simd.h"
#include "tracking/sdf_sums.h"
#include "tracking/tracker.h"

namespace tessera {

class SdfTracker : public Tracker {
  public:
    struct Config {
        double distance_scale_m = 0.02;
        double depth_exponent = 2.0;
        bool normalise = true;
        int finest_step_px = 2;
        int levels = 3;
        int coarse_iterations = 20;
        int fine_iterations = 6;

        void Describe(ConfigParameters& parameters);
    };

    // `model` must outlive the tracker. Without `use_colour` it tracks by geometry alone. `device`
    // must also outlive it; null takes the sums on the CPU.
    SdfTracker(const Config& config, const PinholeCamera& camera, const TrackJudge& judge,
               ResidualModel& model, bool use_colour, VectorPath path = VectorPath::kAuto,
               SdfSums* device = nullptr);

    TrackResult Track(const TrackInput& input) override;

  private:
    struct State;  // of one call to Track

    void MakePoints(const TrackInput& input, int step, FramePoints& points, State& state) const;
    void PrepareLevel(const TrackInput& input, int level, State& state);
    void ChooseStart(const TrackInput& input, State& state);
    void RunLevel(const TrackInput& input, int level, State& state);
    PoseSums SumAt(const TrackInput& input, const FramePoints& points, State& state) const;

    Config config_;
    PinholeCamera camera_;
    TrackJudge judge_;
    ResidualModel& residual_model_;
    bool use_colour_;
    VectorPath path_;
    SdfSums* device_;
    std::vector<FramePoints> points_;  // per level
    PointResiduals residuals_;         // of the finest level
};

}  // namespace tessera
