// Which views are remembered: a new one where the last one has left less than a certain share of
// the picture.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/camera.h"
#include "mapping/prepared_frame.h"
#include "optimize/keyframe.h"
#include "tracking/tracker.h"

namespace tessera {

// Of the points of `depth_m` (of the camera `view`), the share that the same camera sees in its
// image from where T_other_this puts it, at most a fifth larger or smaller: walking straight ahead,
// too, one sees new things. 0 if there are none. Thread-safe.
double ViewOverlap(const DepthImage& depth_m, const PinholeCamera& view,
                   const Eigen::Isometry3d& T_other_this);

// The nearest pixel of every step-th, for ViewOverlap.
DepthImage ReducedDepth(const DepthImage& depth_m, int step);

// Owner thread only.
class Keyframes {
  public:
    // `max_overlap`: the share that a new keyframe may have in common with the last. `max_features`
    // of each.
    Keyframes(const PinholeCamera& camera, double max_overlap, int max_features)
        : camera_(camera), max_overlap_(max_overlap), max_features_(max_features) {}

    // Every tracked frame, in order: counts the way.
    void Follow(const Eigen::Isometry3d& T_map_camera);
    // Whether a frame, the last one followed, should become one.
    bool Wanted(const PreparedFrame& frame, const Eigen::Isometry3d& T_map_camera) const;
    // Its T_world_camera is the last keyframe's, moved on by as much as it is away in the map.
    Keyframe& Add(std::int64_t frame_index, double stamp_s, const PreparedFrame& frame,
                  const TrackResult& track);
    // The map was moved, the last pose with it: the way goes on from there.
    void Move(const Eigen::Isometry3d& T_new_old) { T_map_last_ = T_new_old * T_map_last_; }

    // Before the first: goes on after keyframes of an earlier run; the way goes on from the last
    // one.
    void Resume(std::vector<Keyframe> keyframes);

    // What lies between the last frame and the next is no way that was gone.
    void Jump() { followed_ = false; }

    bool empty() const { return keyframes_.empty(); }
    int size() const { return static_cast<int>(keyframes_.size()); }
    Keyframe& operator[](int id) { return keyframes_[static_cast<std::size_t>(id)]; }
    const Keyframe& operator[](int id) const { return keyframes_[static_cast<std::size_t>(id)]; }
    Keyframe& last() { return keyframes_.back(); }
    const Keyframe& last() const { return keyframes_.back(); }

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
