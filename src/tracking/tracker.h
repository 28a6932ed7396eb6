// Input and output of every tracking method, so that methods can be switched between two frames.
// Trackers read the map and never write it.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/frame_motion.h"
#include "mapping/block_map.h"
#include "mapping/prepared_frame.h"
#include "tracking/point_kernels.h"

namespace tessera {

struct TrackInput {
    const PreparedFrame& frame;
    const BlockMap& map;
    // Candidate camera poses: first the motion model's prediction, then perhaps others. A tracker
    // starts from the one that fits best. Along motions that the frame does not constrain, the
    // result stays at the last candidate, or at the first if the last is too far from it. Not
    // empty.
    std::vector<Eigen::Isometry3d> T_world_camera_starts;
    Eigen::Isometry3d T_world_camera_last;  // the pose at the last tracked frame
    double since_last_s = 0;                // 0 if there is none, or its pose was poor
    int frames_since_last = 1;              // more if frames between were lost
    // The frame follows a tracked one: colours that contradict the map are then wrong colours.
    // Otherwise, they may be those of another place.
    bool place_known = false;
    // Delays and read-out times; the tracker fills in the twist.
    FrameMotion motion = {};
    double nearest_m = kMinWeightDepth_m;  // nearer points have the weight of this depth
};

enum class TrackStatus {
    kGood,  // may be fused
    kPoor,  // has a pose, but must not be fused: `reason` says why
    kLost,  // no pose
};
const char* ToString(TrackStatus status);

struct TrackResult {
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    FrameMotion motion = {};  // while the frame was taken
    TrackStatus status = TrackStatus::kLost;
    std::string reason = {};  // human-readable, unless good
    // Some motion is constrained less well than TrackJudge requires. The frame may still be fused.
    bool degenerate = false;
    double known_fraction = 0;   // fraction of the points where the map knows the distance
    double inlier_fraction = 0;  // fraction of the known points within half the band
    double distance_rms_m = 0;   // robustly weighted
    double band_m = 0;           // half width of the band at the points, weighted alike
    double intensity_rms = 0;    // [0, 1]; 0 without photometric term
    // Standard deviation of the least constrained motion. A rotation counts at the scene's depth.
    double uncertainty_m = 0;
    double innovation_m = 0, innovation_rad = 0;  // from the motion model's prediction
    double innovation_share = 0;  // both as shares of what the judge calls good, added up
    // Poor only because of its innovation, or lost because the camera jumped, and not degenerate:
    // the frame may confirm the pose.
    bool unexpected = false;
    double alpha = 0;             // photometric weight in use, [B14] eq. 8
    double gain = 1, offset = 0;  // map intensity = gain * image intensity + offset
    // From a tracker: the colour image contradicts the map and its pose is not to be used, track
    // again without. In a report: that, or the colour camera hangs; the frame's colour was not
    // used.
    bool colour_rejected = false;
    int iterations = 0;
};

class Tracker {
  public:
    virtual ~Tracker() = default;
    // Never throws; a lost track is a regular result. Owner thread only.
    virtual TrackResult Track(const TrackInput& input) = 0;
};

}  // namespace tessera
