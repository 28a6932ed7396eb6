#include "optimize/loop_config.h"

namespace tessera {

void LoopConfig::Describe(ConfigParameters& p) {
    p.Add("enabled", enabled,
          "close loops, and relocalise after tracking is lost; same as --loop-closure");
    p.Add("max_overlap", max_overlap, {0.1, 0.99}, "",
          "add a keyframe when the view shares less than this fraction with the last one; more "
          "keyframes find more loops but cost more time");
    p.Add("overlaps", overlaps,
          "align keyframes that see the same surface directly; finds drift that tracking hides by "
          "sliding onto the old surface");
    p.Add("max_features", max_features, {100, 5000}, "", "ORB features per keyframe");
    p.Add("memory_limit_mb", memory_limit_mb, {10.0, 1e6}, "MB",
          "for the frames from which a corrected map is built, where they cannot be kept in a "
          "temporary file (in $TMPDIR, or /var/tmp), and for their detections; above it every "
          "second frame is dropped, repeatedly");
    p.Add("min_gap", min_gap, {1, 1000}, "keyframes",
          "search for loops only among keyframes at least this much older");
    p.Add("candidates", candidates, {1, 50}, "",
          "number of most similar keyframes that are checked closely");
    p.Add("min_votes", min_votes, {1, 1000}, "",
          "similar features needed to make a keyframe a candidate");
    p.Add("min_inliers", min_inliers, {6, 1000}, "",
          "features that must agree on one rigid motion");
    p.Add("min_spread_m", min_spread_m, {0.0, 10.0}, "m",
          "spread of these features along their second longest axis, less in proportion where "
          "their median depth is under 1 m; a single poster is not enough to recognise a place");
    p.Add("min_known_fraction", min_known_fraction, {0.0, 1.0}, "",
          "share of the depth that must lie in the known part of the other side's field");
    p.Add("min_fit", min_fit, {0.0, 1.0}, "",
          "share of that depth that must lie within half the band of the surface");
    p.Add("max_disagreement_m", max_disagreement_m, {0.0, 1.0}, "m",
          "largest difference between the alignments of new to old and of old to new; the same "
          "number applies in radians");
    p.Add("max_drift", max_drift, {0.0, 1.0}, "",
          "drift that a loop may correct, as a share of the distance and rotation covered since, "
          "in addition to 15 cm and 0.15 rad; rejects loops between two rooms that look alike");
    p.Add("min_correction_m", min_correction_m, {0.0, 1.0}, "m",
          "loops that features find with less drift (the same number applies in radians) are "
          "recorded but correct nothing");
    p.Add("rebuild_frames", rebuild_frames, {1, 100000}, "frames",
          "stored frames fused into the corrected map after each new frame");
    p.Add("parts", parts,
          "where a lost camera is found nowhere for two seconds, begin a new part of the scan, and "
          "join it with the others when a place is seen again; not with a bounded mapping.volume");
}

}  // namespace tessera
