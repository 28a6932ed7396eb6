// Whether two views are of one place, and how they lie to each other: by features, then by drift,
// then by the field. Wrong loops ruin a map, missed ones do little harm: it errs on the side of no.
#pragma once

#include "optimize/feature_match.h"
#include "optimize/field_check.h"
#include "optimize/keyframes.h"

namespace tessera {

// What an odometry that ends there would have to be off by, and whether it can be.
struct Drift {
    double off_m = 0, off_rad = 0;
    bool possible = false;
};

// Between two keyframes whose true relation would be T_old_new.
Drift DriftOf(const Keyframe& old, const Keyframe& fresh, const Eigen::Isometry3d& T_old_new,
              double max_drift);

// Owner thread only.
class LoopVerifier {
  public:
    LoopVerifier(const FieldSettings& settings, const LoopConfig& config)
        : config_(config), field_(settings, config) {}

    // Of a keyframe `fresh`, made of the frame `prepared`.
    FieldVerdict VerifyLoop(const Keyframes& keyframes, const Keyframe& old, const Keyframe& fresh,
                            const PreparedFrame& prepared, const FrameMotion& motion,
                            FrameStore& store);
    // By the field alone, of a lost camera's frame that the features put at T_old_new.
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
