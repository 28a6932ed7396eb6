// Tracks a frame against a predicted view of the map by coarse-to-fine point-to-plane ICP with
// projective association and Levenberg-Marquardt ([D18] section 3.2), alone or with a photometric
// term against the predicted colours.
#pragma once

#include <memory>
#include <vector>

#include "mapping/predicted_view.h"
#include "tracking/conclude.h"
#include "tracking/frame_points.h"
#include "tracking/icp_model.h"
#include "tracking/icp_sums.h"
#include "tracking/levenberg_marquardt.h"
#include "tracking/tracker.h"

namespace tessera {

class IcpTracker : public Tracker {
  public:
    enum class Prediction { kRayCast, kRaster };

    struct Config {
        Prediction prediction = Prediction::kRayCast;
        int finest_step_px = 0;
        int levels = 3;
        int coarse_iterations = 10;
        int middle_iterations = 8;
        int fine_iterations = 4;
        double distance_gate_m = 0.1;
        double normal_gate_rad = 0.8;
        int normal_radius_px = 4;
        double distance_scale_m = 0.02;
        double noise_depth_m = 2.0;

        void Describe(ConfigParameters& parameters);
    };
    static constexpr int kStepAtVga_px = 2;  // of the finest level, unless configured

    // `model` must outlive the tracker. Without `use_colour` it tracks by geometry alone.
    // `predictor` predicts the views; null: `sums` casts them. `sums`, if given, must also outlive
    // the tracker; null: a CpuIcpSums of its own.
    IcpTracker(const Config& config, const PinholeCamera& camera, const TrackJudge& judge,
               ResidualModel& model, bool use_colour,
               std::unique_ptr<ViewPredictor> predictor = nullptr, IcpSums* sums = nullptr);

    TrackResult Track(const TrackInput& input) override;

  private:
    struct State;  // of one call to Track

    void PredictAt(const TrackInput& input, const Eigen::Isometry3d& T_world_view, State& state);
    void ChooseStart(const TrackInput& input, State& state);
    void PrepareLevel(const TrackInput& input, int level, State& state);
    void RunLevel(int level, State& state);
    enum class Compare { kWithNothing, kWithKept };  // energies with those of the kept residuals
    PoseSums SumAt(const FramePoints& points, Compare compare, State& state);
    void KeepResiduals() { sums_.KeepResiduals(residuals_, trial_residuals_); }
    void TakeStep(const FramePoints& points, State& state);

    Config config_;
    int finest_step_px_;
    PinholeCamera camera_;
    TrackJudge judge_;
    ResidualModel& residual_model_;
    bool use_colour_;
    std::unique_ptr<ViewPredictor> predictor_;
    std::unique_ptr<IcpSums> own_sums_;
    IcpSums& sums_;
    PredictedView view_;
    std::vector<IcpModelLevel> model_;  // per level
    std::vector<FramePoints> points_;   // per level
    // of one level: the kept ones, and those of the last sum
    PointResiduals residuals_, trial_residuals_;
};

}  // namespace tessera
