// Aligns a frame with the previous one on strongly reduced images: intensity and depth together,
// six degrees of freedom. Not accurate, but it finds fast motions outside the small convergence
// basins of the field's narrow band and of the texture. Trackers use its result as one more start,
// beside that of the motion model.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <tuple>
#include <vector>

#include "core/camera.h"
#include "core/config.h"
#include "core/cpu.h"
#include "core/state_stream.h"
#include "mapping/prepared_frame.h"

namespace tessera {

class ImageSystem;

class ImageAligner {
  public:
    struct Config {
        bool enabled = true;
        int iterations = 10;
        int starts = 3;

        void Describe(ConfigParameters& parameters);
    };

    ImageAligner(const Config& config, const PinholeCamera& camera,
                 VectorPath path = VectorPath::kAuto);

    // Takes `frame` as the newest and aligns it with the kept frame, starting from
    // `T_last_current_guess`. Returns T_last_current, or the guess itself if there is nothing to
    // align. Owner thread only.
    Eigen::Isometry3d Align(const PreparedFrame& frame,
                            const Eigen::Isometry3d& T_last_current_guess);
    // Whether to keep the newest frame for aligning the next one (the default). Pass false if its
    // pose is unknown. The next frame is then aligned with the same frame as this one.
    void KeepNewest(bool keep) { keep_newest_ = keep; }
    void Clear();
    // The state is the kept frame, reduced; 48 KB at 4:3.
    void SaveState(StateWriter& state) const;
    bool LoadState(StateReader& state);
    // Overrides the configuration.
    void Enable(bool on) {
        config_.enabled = on;
        if (!on) Clear();
    }

  private:
    // One reduced image, and its points for AlignArguments.
    struct Level : PreparedFrame::Reduced {
        PinholeCamera camera;
        std::vector<float> x, y, z, intensity_of_point;
    };
    // Coarse to fine.
    using Levels = std::array<Level, std::tuple_size_v<decltype(PreparedFrame::reduced)>>;

    PinholeCamera ReducedCamera(std::size_t level) const;
    static void MakePoints(Level& level);
    Eigen::Isometry3d Refine(const Eigen::Isometry3d& T_last_current, double& score) const;
    ImageSystem Linearise(const Level& last, const Level& current,
                          const Eigen::Isometry3d& T_current_last, double offset) const;

    Config config_;
    PinholeCamera camera_;
    VectorPath path_;
    Levels last_, current_;
    bool has_last_ = false, has_current_ = false, keep_newest_ = true;
    double scene_depth_m_ = 0;
    double usual_score_ = 0;  // of alignments so far, 0 before the first
};

}  // namespace tessera
