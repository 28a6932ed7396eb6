// Chooses the frames that a texture is made from: the sharpest of each stretch of the path.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/frame.h"
#include "core/se3.h"

namespace tessera {

// Only a few frames of each stretch need to be read: those at which the camera turned least. Owner
// thread only.
class ViewChoice {
  public:
    // A stretch ends where the camera has moved so far from its first pose. Within it, frames show
    // nearly the same, so their sharpness may be compared. On a long path stretches are longer, so
    // that there are at most kMostStretches.
    static constexpr double kStretch_m = 0.05, kStretch_rad = 0.06;
    static constexpr int kMostStretches = 1000;
    static constexpr std::size_t kCandidates = 3;  // of a stretch
    // Time stamps are the same: a trajectory file has microseconds.
    static constexpr double kSame_s = 1.5e-6;

    // `path`: by increasing time.
    ViewChoice(std::span<const StampedPose> path, const PinholeCamera& camera);

    // Time stamps of the frames to read, increasing.
    const std::vector<double>& stamps_s() const { return stamps_s_; }
    // Which of them a frame is; nullopt if it is none of them.
    std::optional<std::size_t> Find(const Frame& frame) const;

    // Takes candidate `number`, with colour and T_world_camera; in order, but some may be left out.
    // Returns the sharpest of the stretch before, if a new one begins.
    std::optional<Frame> Offer(const Frame& frame, std::size_t number);
    // The sharpest of the last stretch.
    std::optional<Frame> Last();

  private:
    std::vector<double> stamps_s_;
    std::vector<int> stretches_;  // of the stamps
    std::optional<Frame> best_;
    double best_sharpness_ = 0;
    int stretch_ = -1;  // of best_
};

}  // namespace tessera
