// What the colour images teach from frame to frame, whatever method tracks: the photometric weight, the brightness of
// the camera against the map, and when the colour image's rows were taken. One object serves all methods, so that a
// switch between two frames loses nothing.
#pragma once

#include <functional>

#include "core/config.h"
#include "tracking/residual_sums.h"
#include "tracking/shutter_estimator.h"
#include "tracking/tracker.h"

namespace tessera {

// Owner thread only.
class Photometry {
  public:
    enum class AlphaMode { kFixed, kAuto };

    struct Config {
        AlphaMode alpha_mode = AlphaMode::kAuto;
        double alpha = 0.05;
        double auto_alpha_min = 0.003;
        double auto_alpha_max = 0.08;
        double shading_error = 0.02;
        double intensity_scale = 0.1;
        bool brightness = true;
        double brightness_prior = 0.05;
        ShutterEstimator::Config shutter;

        void Describe(ConfigParameters& parameters);
    };

    explicit Photometry(const Config& config);
    // Forgets what was learnt, not the configuration.
    void Reset();
    void SaveState(StateWriter& state) const;
    bool LoadState(StateReader& state);
    // In place of the configuration's: learnt from here on, or fixed at `alpha`, in m^2.
    void SetAlpha(bool automatic, double alpha);

    const Config& config() const { return config_; }
    double alpha() const { return alpha_; }  // in use, [B14] eq. 8
    double gain() const { return gain_; }    // of the last tracked frame: map = gain * image + offset
    double offset() const { return offset_; }
    // The motion with the colour image's delay and read-out as learnt so far.
    FrameMotion Timed(FrameMotion motion) const;

    // One tracked frame: the pose that was found, the residuals of its finest points, and who sums them (SumResiduals, or a
    // device that has them; then the arrays are not read).
    void Learn(const TrackResult& result, ResidualArguments residuals,
               const std::function<ResidualSums(const ResidualArguments&)>& sum);

  private:
    void UpdateAlpha(const ResidualSums& sums);

    Config config_;
    double alpha_ = 0, gain_ = 1, offset_ = 0;
    double distance_variance_ = 0, intensity_variance_ = 0;  // as they count in a sum, smoothed over frames
    ShutterEstimator shutter_;
};

}  // namespace tessera
