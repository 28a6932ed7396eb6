// Keeps the frames from which corrected maps are made: each alone, or averaged with its neighbours.
#pragma once

#include <string>

#include "optimize/frame_average.h"
#include "optimize/frame_store.h"

namespace tessera {

// Owner thread only.
class FrameKeeper {
  public:
    // As for FrameStore. `average`: whether frames may be averaged at all.
    FrameKeeper(const PinholeCamera& camera, std::size_t memory_limit_bytes,
                double depth_units_per_m, bool average);

    // Keeps a frame, seen from T_keyframe_camera of the keyframe `id`. `alone`: not averaged, as
    // `first`, the keyframe's own, which calibration compares with others. Returns errors of the
    // encoder.
    Status Add(const Frame& frame, int id, bool first, bool alone,
               const Eigen::Isometry3d& T_keyframe_camera, const Integrator::View& view);
    // Stores the average of the latest frames, too, so that the store has all of them.
    void StoreLatest();

    FrameStore& store() { return store_; }
    const FrameStore& store() const { return store_; }
    // Returns once why frames are missing, or why images are kept in memory; usually empty.
    std::string TakeTrouble();

  private:
    Status StoreAverage();

    bool average_frames_;
    FrameAverage average_;  // of the latest frames, not stored yet
    int keyframe_ = 0;      // of the average
    FrameStore store_;
    std::string trouble_;
};

}  // namespace tessera
