// What the residuals teach from frame to frame, whatever the tracking method: the size of distance
// and intensity errors, and hence their relative weight; the camera's brightness relative to the
// map; when the colour image's rows were taken. One object serves all methods, so that a switch
// between two frames loses nothing. docs/information.md has the derivation.
#pragma once

#include "core/config.h"
#include "tracking/pose_solver.h"
#include "tracking/residual_sums.h"
#include "tracking/shutter_estimator.h"
#include "tracking/tracker.h"

namespace tessera {

// Variances of residuals of weight 1 in a sum over many points. Errors of neighbours are
// correlated, so they are larger than the scatter of single residuals.
struct ResidualScales {
    double distance_m2 = 0;  // 0: not known yet
    // The same, of the last frame: it depends on what the frame shows.
    double intensity = 0;
    // Fraction of the map's image gradients that the last frame confirms; the rest is noise.
    double texture = 1;
    // Ratio of the two, smoothed, with their disagreement shared between them; 0: not known yet.
    double alpha = 0;
};

// What one frame says about the scales.
struct ResidualEvidence {
    const ResidualArguments& arguments;
    const ResidualSums& sums;  // of `arguments`
    // At the found pose, Normalised to scene_depth_m.
    const PoseTerm &distances, &intensities;
    double scene_depth_m, voxel_size_m;
};

// Owner thread only.
class ResidualModel {
  public:
    enum class AlphaMode { kFixed, kAuto };

    struct Config {
        AlphaMode alpha_mode = AlphaMode::kAuto;
        double alpha = 0.02;
        double shading_error = 0.02;
        double surface_error_voxels = 0.1;
        double auto_alpha_max = 0.1;
        double intensity_scale = 0.1;
        bool remove_shading = true;
        bool brightness = true;
        double brightness_prior = 0.05;
        double doubt_contrast = 0.25;
        ShutterEstimator::Config shutter;

        void Describe(ConfigParameters& parameters);
    };

    explicit ResidualModel(const Config& config);
    // Forgets what was learnt, but not the configuration.
    void Reset();
    void SaveState(StateWriter& state) const;
    bool LoadState(StateReader& state);
    // Overrides the configuration: alpha is learnt from here on, or fixed at `alpha`, in m^2.
    void SetAlpha(bool automatic, double alpha);

    const Config& config() const { return config_; }
    const ResidualScales& scales() const { return scales_; }
    double alpha() const;                  // in use, [B14] eq. 8
    double gain() const { return gain_; }  // of the last tracked frame: map = gain * image + offset
    double offset() const { return offset_; }
    // The motion with the colour image's delay and read-out time as learnt so far.
    FrameMotion Timed(FrameMotion motion) const;

    // Whether a frame with this motion and intensity residual carries information about the
    // shutter.
    bool WantsShutter(const FrameMotion& motion, double intensity_rms) const {
        return shutter_.Wants(motion, intensity_rms);
    }
    // Whether the frame's intensity errors may be shading: not if they are much larger than usual.
    // `sums`: of the finest points.
    bool TakesForShading(const PoseSums& sums) const;
    // Whether the colour image contradicts the map, as that of a dark or dazzled camera: it does
    // not show the map's contrast, and its errors are much larger than usual. After such an image,
    // the next must show the contrast, whatever its errors. False while nothing is usual yet.
    bool Contradicts(const ResidualSums& sums, double intensity_rms);
    // Learns from any frame that fits the map.
    void LearnScales(const ResidualEvidence& evidence);
    // Learns from a tracked frame. A `degenerate` pose explains residuals that it should not; the
    // shutter is then left alone. `rms_with_shading`: as in FoundPose.
    void LearnColour(const TrackResult& result, const ResidualSums& sums,
                     double rms_with_shading = 0);

  private:
    Config config_;
    double gain_ = 1, offset_ = 0;
    ResidualScales scales_;
    double scatter_ = 0;  // of intensities, as scales_.intensity without shading; smoothed
    ShutterEstimator shutter_;
    // Not saved: they are soon known again.
    double usual_rms_ = 0;  // of intensities, with their shading; 0: not known
    bool contradicted_ = false;
};

}  // namespace tessera
