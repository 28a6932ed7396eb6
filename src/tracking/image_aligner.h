// Aligns a frame with the one before it on heavily reduced images: intensity and depth together,
// all six motions. Not accurate, but it finds fast motions that the field's narrow band and the
// texture's small basin would miss; trackers take its answer as one more start, beside the motion
// model's.
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

    // Takes `frame` as the newest and aligns it with the one kept before. `T_last_current_guess` is
    // where to start. The result is T_last_current; the guess itself if there is nothing to align.
    // Owner thread only.
    Eigen::Isometry3d Align(const PreparedFrame& frame,
                            const Eigen::Isometry3d& T_last_current_guess);
    // Whether the newest frame is kept, as it is without a word, to align the next one with. False:
    // where it was taken is not known, and the next one is aligned with the frame that this one was
    // aligned with.
    void KeepNewest(bool keep) { keep_newest_ = keep; }
    void Clear();
    // The kept frame, reduced; 48 KB at 4:3.
    void SaveState(StateWriter& state) const;
    bool LoadState(StateReader& state);
    // In place of the configuration's.
    void Enable(bool on) {
        config_.enabled = on;
        if (!on) Clear();
    }

  private:
    // One reduced image, and AlignArguments' points of it.
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
    bool use_avx2_;
    Levels last_, current_;
    bool has_last_ = false, has_current_ = false, keep_newest_ = true;
    double scene_depth_m_ = 0;
    double usual_score_ = 0;  // of alignments so far, 0 before the first
};

}  // namespace tessera
