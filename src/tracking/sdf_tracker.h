// Tracks a frame directly in the signed distance field by Gauss-Newton on distances and intensities
// ([B14] eq. 8-11; alpha = 0 gives [B13]), coarse to fine over subsampled points.
#pragma once

#include <memory>
#include <vector>

#include "tracking/conclude.h"
#include "tracking/frame_points.h"
#include "tracking/sdf_sums.h"
#include "tracking/tracker.h"

namespace tessera {

class SdfTracker : public Tracker {
  public:
    struct Config {
        double distance_scale_m = 0.02;
        double noise_depth_m = 2.0;
        bool normalise = true;
        bool chroma = false;
        int finest_step_px = 0;
        int levels = 3;
        int coarse_iterations = 20;
        int fine_iterations = 6;

        void Describe(ConfigParameters& parameters);
    };
    static constexpr int kStepAtVga_px = 3;  // of the finest level, unless configured

    // `model` must outlive the tracker. Without `use_colour` it tracks by geometry alone. `sums`,
    // if given, must also outlive it; null: a CpuSdfSums of its own.
    SdfTracker(const Config& config, const PinholeCamera& camera, const TrackJudge& judge,
               ResidualModel& model, bool use_colour, SdfSums* sums = nullptr);

    TrackResult Track(const TrackInput& input) override;

  private:
    struct State;  // of one call to Track

    void MakePoints(const TrackInput& input, int step, FramePoints& points, State& state);
    void PrepareLevel(const TrackInput& input, int level, State& state);
    void ChooseStart(const TrackInput& input, State& state);
    void RunLevel(const TrackInput& input, int level, State& state);
    PoseSums SumAt(const TrackInput& input, const FramePoints& points, State& state);

    Config config_;
    int finest_step_px_;
    PinholeCamera camera_;
    TrackJudge judge_;
    ResidualModel& residual_model_;
    bool use_colour_;
    std::unique_ptr<SdfSums> own_sums_;
    SdfSums& sums_;
    std::vector<FramePoints> points_;  // per level
    PointResiduals residuals_;         // of the finest level
};

}  // namespace tessera
