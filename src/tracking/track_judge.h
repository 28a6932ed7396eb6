// Whether a tracked frame may be trusted: the same rules for every method, from the sums at the pose that it found.
#pragma once

#include <cstdint>

#include "core/config.h"
#include "tracking/pose_solver.h"
#include "tracking/tracker.h"

namespace tessera {

// Immutable; thread-safe.
class TrackJudge {
  public:
    struct Config {
        double min_eigenvalue = 5e-4;
        double min_known_fraction = 0.1;
        double min_inlier_fraction = 0.2;
        double good_inlier_fraction = 0.35;
        double good_distance_rms_m = 0.03;
        double max_jump_m = 0.3;
        double max_jump_rad = 0.5;
        double good_innovation_m = 0.2;
        double good_innovation_rad = 0.35;

        void Describe(ConfigParameters& parameters);
    };

    explicit TrackJudge(const Config& config) : config_(config) {}

    // Fills the figures, the status and the reason of a result whose pose is set. `sums` and `step` are the finest
    // level's last, `points` how many points had depth there.
    void Judge(const TrackInput& input, std::int64_t points, const PoseSums& sums, const PoseStep& step,
               TrackResult& result) const;

    // Motions whose share of the normalised Hessian is smaller are held by the solver.
    double min_eigenvalue() const { return config_.min_eigenvalue; }

  private:
    TrackStatus Status(const TrackInput& input, const PoseStep& step, TrackResult& result) const;

    Config config_;
};

}  // namespace tessera
