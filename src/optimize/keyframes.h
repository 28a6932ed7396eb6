// Selects keyframes: adds one when the view shares less than a given fraction with the last
// keyframe.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/frame_motion.h"
#include "mapping/prepared_frame.h"
#include "optimize/keyframe.h"
#include "tracking/tracker.h"

namespace tessera {

// Share of the points of `depth_m` (camera `view`) that the same camera sees after moving by
// T_other_this. Points whose depth changes by more than a fifth do not count, so that walking
// straight ahead also yields keyframes. 0 if there are no points. Thread-safe.
double ViewOverlap(const DepthImage& depth_m, const PinholeCamera& view,
                   const Eigen::Isometry3d& T_other_this);

// Subsamples every step-th pixel, for ViewOverlap.
DepthImage ReducedDepth(const DepthImage& depth_m, int step);

// Owner thread only.
class Keyframes {
  public:
    // `max_overlap`: the largest share that a new keyframe may have in common with the last.
    // `max_features`: per keyframe.
    Keyframes(const PinholeCamera& camera, double max_overlap, int max_features)
        : camera_(camera), max_overlap_(max_overlap), max_features_(max_features) {}

    // Call for every tracked frame, in order. Accumulates the path length and rotation.
    void Follow(const Eigen::Isometry3d& T_map_camera);
    // True if the frame, the last one followed, should become a keyframe.
    bool Wanted(const PreparedFrame& frame, const Eigen::Isometry3d& T_map_camera) const;
    // The caller sets its T_world_camera. `motion`: while it was captured.
    Keyframe& Add(std::int64_t frame_index, double stamp_s, const PreparedFrame& frame,
                  const TrackResult& track, const FrameMotion& motion = {});
    // The map was moved, and the last pose with it; the path continues from there.
    void Move(const Eigen::Isometry3d& T_new_old) { T_map_last_ = T_new_old * T_map_last_; }

    // Before the first Add: continues with the keyframes of an earlier run. The path continues from
    // the last one.
    void Resume(std::vector<Keyframe> keyframes);

    // The step from the last frame to the next does not count as path.
    void Jump() { followed_ = false; }

    bool empty() const { return keyframes_.empty(); }
    int size() const { return static_cast<int>(keyframes_.size()); }
    Keyframe& operator[](int id) { return keyframes_[static_cast<std::size_t>(id)]; }
    const Keyframe& operator[](int id) const { return keyframes_[static_cast<std::size_t>(id)]; }
    Keyframe& last() { return keyframes_.back(); }
    const Keyframe& last() const { return keyframes_.back(); }
    std::span<const Keyframe> all() const { return keyframes_; }
    const Eigen::Isometry3d& T_map_last() const { return T_map_last_; }  // the last one followed

  private:
    PinholeCamera camera_;
    double max_overlap_;
    int max_features_;
    std::vector<Keyframe> keyframes_;
    Eigen::Isometry3d T_map_last_ = Eigen::Isometry3d::Identity();
    bool followed_ = false;
    double way_m_ = 0, turned_rad_ = 0;
};

}  // namespace tessera
