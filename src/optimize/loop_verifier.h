// Decides whether two views show the same place and finds their relative pose: by features, then
// drift, then field. A wrong loop ruins the map, a missed one does little harm, so the checks are
// strict.
#pragma once

#include "optimize/feature_match.h"
#include "optimize/field_check.h"
#include "optimize/keyframes.h"

namespace tessera {

// Drift of the odometry that a loop implies.
struct Drift {
    double off_m = 0, off_rad = 0;
    bool possible = false;  // for the distance and rotation covered since
    // Larger, but still less than two rooms of one kind lie apart: to be believed if the texture is
    // the same.
    bool conceivable = false;
};

// Between two keyframes, if their true relative pose is T_old_new.
Drift DriftOf(const Keyframe& old, const Keyframe& fresh, const Eigen::Isometry3d& T_old_new,
              double max_drift);

// Owner thread only.
class LoopVerifier {
  public:
    LoopVerifier(const FieldSettings& settings, const LoopConfig& config)
        : config_(config), field_(settings, config) {}

    struct Match {
        std::optional<Eigen::Isometry3d> T_old_new;
        bool ask_for_texture = false;  // with less drift it would be another place of that kind
    };
    // By features, if the drift that follows is conceivable.
    Match MatchKeyframes(const Keyframe& old, const Keyframe& fresh) const;
    // For a keyframe `fresh`, made from the frame `prepared`, which features place at T_old_new.
    FieldVerdict VerifyLoop(const Keyframes& keyframes, const Keyframe& old, const Keyframe& fresh,
                            const Eigen::Isometry3d& T_old_new, const PreparedFrame& prepared,
                            const FrameMotion& motion, FrameStore& store);
    // Field check only, for a frame of a lost camera that the features place at T_old_new.
    FieldVerdict VerifyPlace(const Keyframes& keyframes, const Keyframe& old,
                             const PreparedFrame& fresh, const Eigen::Isometry3d& T_old_new,
                             FrameStore& store);

  private:
    bool NothingToCorrect(const Eigen::Isometry3d& T_measured,
                          const Eigen::Isometry3d& T_expected) const;
    std::vector<NearFrame> FramesNear(const Keyframes& keyframes, int keyframe,
                                      const FrameStore& store) const;

    LoopConfig config_;
    FieldCheck field_;
};

}  // namespace tessera
