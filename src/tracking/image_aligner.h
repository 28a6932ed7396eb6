// Aligns a frame with the one before it on heavily reduced images: intensity and depth together, all six motions. Not
// accurate, but it finds fast motions that the field's narrow band and the texture's small basin would miss; trackers
// take its answer as one more start, beside the motion model's.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/camera.h"
#include "core/config.h"
#include "core/state_stream.h"
#include "mapping/prepared_frame.h"

namespace tessera {

struct ImageSystem;

class ImageAligner {
  public:
    struct Config {
        bool enabled = true;
        int iterations = 10;
        int starts = 3;

        void Describe(ConfigParameters& parameters);
    };

    ImageAligner(const Config& config, const PinholeCamera& camera);

    // Takes `frame` as the newest and aligns it with the one given before. `T_last_current_guess` is where to start. The
    // result is T_last_current; the guess itself if there is nothing to align. Owner thread only.
    Eigen::Isometry3d Align(const PreparedFrame& frame, const Eigen::Isometry3d& T_last_current_guess);
    void Clear();
    // The last frame, reduced; 48 KB at 4:3.
    void SaveState(StateWriter& state) const;
    bool LoadState(StateReader& state);
    // In place of the configuration's.
    void Enable(bool on) {
        config_.enabled = on;
        if (!on) Clear();
    }

  private:
    // One reduced image; intensity smoothed by averaging, depth sampled; -1 and 0 where missing.
    struct Level {
        PinholeCamera camera;
        Image<float> intensity;
        DepthImage depth_m;
    };

    PinholeCamera ReducedCamera(int width) const;
    void Reduce(const PreparedFrame& frame, std::vector<Level>& levels) const;
    Eigen::Isometry3d Refine(const Eigen::Isometry3d& T_last_current, double& score) const;
    ImageSystem Linearise(const Level& last, const Level& current, const Eigen::Isometry3d& T_current_last,
                     double offset) const;

    Config config_;
    PinholeCamera camera_;
    std::vector<Level> last_, current_;  // coarse to fine
    bool has_last_ = false;
    double scene_depth_m_ = 0;
    double usual_score_ = 0;  // of alignments so far, 0 before the first
};

}  // namespace tessera
