// Whether two views are of one place, and how they lie to each other: by features, then by drift, then by the field. Wrong
// loops ruin a map, missed ones do little harm: it errs on the side of no.
#pragma once

#include <optional>
#include <string>

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
Drift DriftOf(const Keyframe& old, const Keyframe& fresh, const Eigen::Isometry3d& T_old_new, double max_drift);

// Owner thread only.
class LoopVerifier {
  public:
    LoopVerifier(const FieldSettings& settings, const LoopConfig& config) : config_(config), field_(settings, config) {}

    // T_old_new of a keyframe `fresh`, whose frame need not be stored yet; nothing if it is refused.
    std::optional<Eigen::Isometry3d> VerifyLoop(const Keyframes& keyframes, const Keyframe& old, const Keyframe& fresh,
                                                const PreparedFrame& prepared, FrameStore& store);
    // By the field alone, of a frame that the features put at T_old_new.
    std::optional<Eigen::Isometry3d> VerifyPlace(const Keyframes& keyframes, const Keyframe& old,
                                                 const PreparedFrame& fresh, const Eigen::Isometry3d& T_old_new,
                                                 FrameStore& store);

    // Why the last one was refused, in words.
    const std::string& reason() const { return reason_; }

  private:
    std::vector<NearFrame> FramesNear(const Keyframes& keyframes, int keyframe, const FrameStore& store) const;

    LoopConfig config_;
    FieldCheck field_;
    std::string reason_;
};

}  // namespace tessera
