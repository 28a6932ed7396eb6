// Learns, while the camera turns, when the rows of the colour image were really taken: a constant
// delay beyond the timestamps, and the read-out time of a rolling shutter. Both shear the image of
// a moving camera, which shows in the photometric residuals. A global shutter is learnt as zero.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/config.h"
#include "core/frame_motion.h"
#include "core/state_stream.h"
#include "tracking/residual_kernels.h"

namespace tessera {

class ShutterEstimator {
  public:
    struct Config {
        bool enabled = true;
        double delay_prior_s = 0.005;
        double readout_prior_s = 0.02;
        double readout_s = 0;

        void Describe(ConfigParameters& parameters);
    };

    explicit ShutterEstimator(const Config& config) : config_(config) { Reset(); }

    // Whether a frame with this motion and photometric residuals of this size carries information.
    bool Wants(const FrameMotion& motion, double residual_scale) const;
    // Learns from one tracked frame: ShutterSums (residual_kernels.h) of its residuals, which are
    // map - (gain * image + offset). Owner thread only.
    void Update(const std::vector<double>& sums, double residual_scale);
    void Reset();
    void SaveState(StateWriter& state) const;
    // If it is not enabled, what the state has learnt is forgotten.
    bool LoadState(StateReader& state);

    double delay_s() const { return estimate_(0); }    // to add to the difference of timestamps
    double readout_s() const { return estimate_(1); }  // of the whole colour image

  private:
    Config config_;
    Eigen::Vector2d estimate_;
    Eigen::Matrix2d information_;
};

}  // namespace tessera
