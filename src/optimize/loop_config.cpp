#include "optimize/loop_config.h"

namespace tessera {

void LoopConfig::Describe(ConfigParameters& p) {
    p.Add("enabled", enabled,
          "close loops and find the place again after a loss; as --loop-closure");
    p.Add("max_overlap", max_overlap, {0.1, 0.99}, "",
          "a new keyframe where less of the picture is shared with the last; more keyframes find "
          "more loops and cost more");
    p.Add("max_features", max_features, {100, 5000}, "", "ORB features of a keyframe");
    p.Add("memory_limit_mb", memory_limit_mb, {10.0, 1e6}, "MB",
          "for the compressed frames that a corrected map is made of; beyond it every second one "
          "is let go, over and over");
    p.Add("min_gap", min_gap, {1, 1000}, "keyframes",
          "loops are sought among keyframes at least so much older");
    p.Add("candidates", candidates, {1, 50}, "",
          "most similar keyframes that are looked at closely");
    p.Add("min_votes", min_votes, {1, 1000}, "",
          "similar features that make a keyframe a candidate");
    p.Add("min_inliers", min_inliers, {6, 1000}, "", "features that must fit one rigid motion");
    p.Add("min_spread_m", min_spread_m, {0.0, 10.0}, "m",
          "across the second longest axis of those features: a poster alone does not make a place");
    p.Add("min_known_fraction", min_known_fraction, {0.0, 1.0}, "",
          "of the depth, the share that must lie in the other side's field");
    p.Add("min_fit", min_fit, {0.0, 1.0}, "",
          "of that, the share that must fit within half the truncation");
    p.Add("max_disagreement_m", max_disagreement_m, {0.0, 1.0}, "m",
          "between the alignments of new with old and of old with new; in radians the same number");
    p.Add("max_drift", max_drift, {0.0, 1.0}, "",
          "share of the way since, in metres and in radians turned, that a loop may correct; "
          "beyond 15 cm and 0.15 rad. "
          "It tells two rooms that look alike from one");
    p.Add("min_correction_m", min_correction_m, {0.0, 1.0}, "m",
          "loops that are off by less (or by as many radians) are noted, but do not move anything");
    p.Add("rebuild_frames", rebuild_frames, {1, 100000}, "frames",
          "stored frames fused into the corrected map after each new frame");
}

}  // namespace tessera
