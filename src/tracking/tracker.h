// What every tracking method takes and gives, so that methods can be switched between two frames.
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
    // Where the camera may be: first the motion model's expectation, then perhaps others. A tracker
    // starts from the one that fits best; along motions that the frame does not know the camera is
    // where the last one has it. Not empty.
    std::vector<Eigen::Isometry3d> T_world_camera_starts;
    Eigen::Isometry3d T_world_camera_last;  // where it was at the last tracked frame
    double since_last_s = 0;                // 0 if there is no such frame, or its pose was poor
    // Delays and read-out times; the twist is the tracker's to fill.
    FrameMotion motion;
    double nearest_m = kNearestWeighed_m;  // nearer points have the weight of this depth
};

enum class TrackStatus {
    kGood,  // fuse it
    kPoor,  // a pose, but not to be trusted with the map: `reason` says why
    kLost,  // no pose
};
const char* ToString(TrackStatus status);

struct TrackResult {
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    FrameMotion motion;  // while the frame was taken
    TrackStatus status = TrackStatus::kLost;
    std::string reason;  // in words, unless good
    // Some motion is known less well than TrackJudge asks; it may still be good to fuse.
    bool degenerate = false;
    double known_fraction = 0;   // of the points, those that lie where the map knows the distance
    double inlier_fraction = 0;  // of the known points, those within half the truncation
    double distance_rms_m = 0;   // robustly weighted
    double intensity_rms = 0;    // [0, 1]; 0 without photometric term
    // Standard deviation of the motion that is known least, a turn counting at the scene's depth.
    double uncertainty_m = 0;
    double innovation_m = 0, innovation_rad = 0;  // from the motion model's expectation
    double alpha = 0;                             // photometric weight in use, [B14] eq. 8
    double gain = 1, offset = 0;                  // map intensity = gain * image intensity + offset
    int iterations = 0;
};

class Tracker {
  public:
    virtual ~Tracker() = default;
    // Never throws; a lost track is a value. Owner thread only.
    virtual TrackResult Track(const TrackInput& input) = 0;
};

}  // namespace tessera
