// Decides whether a tracked frame can be trusted: the same rules for every method, from the sums at
// the pose that it found.
#pragma once

#include <cstdint>

#include "core/config.h"
#include "tracking/pose_information.h"
#include "tracking/tracker.h"

namespace tessera {

// Immutable; thread-safe.
class TrackJudge {
  public:
    struct Config {
        double degenerate_voxels = 0.5;
        double expected_within_m = 0.02;
        double min_known_fraction = 0.1;
        double min_inlier_fraction = 0.2;
        double good_inlier_fraction = 0.35;
        double good_distance_share = 0.75;
        double max_jump_m = 0.3;
        double max_jump_rad = 0.5;
        double good_innovation_m = 0.2;
        double good_innovation_rad = 0.35;
        double doubt_misfit = 0.1;
        double doubt_known_fraction = 0.35;

        void Describe(ConfigParameters& parameters);
    };

    explicit TrackJudge(const Config& config) : config_(config) {}

    // Fills in how well the frame fits the map. `sums` are the last ones of the finest level,
    // `points` is the number of points with depth there. Returns false, with status and reason, if
    // the track is lost; else leaves the status.
    bool Fits(std::int64_t points, const PoseSums& sums, TrackResult& result) const;
    // Fills in status, reason and the remaining fields of a result that fits. Its pose and
    // uncertainty must be set.
    void Judge(const TrackInput& input, TrackResult& result) const;

    // Whether a pose is close enough to another, the motion model's, for its frame to be fused.
    bool Follows(const Eigen::Isometry3d& T_world_expected,
                 const Eigen::Isometry3d& T_world_camera) const;

    // Standard deviation of the pose prior before a frame is seen; 0: no prior.
    double expected_within_m() const { return config_.expected_within_m; }

  private:
    // Also sets reason and `unexpected`.
    void SetStatus(const TrackInput& input, TrackResult& result) const;

    Config config_;
};

}  // namespace tessera
