// What the frames' own depth says about a place: surface, or free space that they look through.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/frame.h"

namespace tessera {

struct Evidence {
    int confirmed = 0;     // frames that measured a surface here
    int seen_through = 0;  // frames that measured one farther away, beyond all noise
};

// Keeps what it needs of the frames at half of their resolution: 0.3 MB for one of 640 x 480.
class FrameEvidence {
  public:
    static constexpr std::int64_t kMostFrames = 300;  // a 5-minute scan: one a second

    // The frame must have depth and T_world_camera; others are left out, as are more than
    // kMostFrames. Owner thread only.
    void Add(const PinholeCamera& camera, const Frame& frame);
    std::size_t frames() const { return views_.size(); }

    // At a point of the world. A frame's depth is compared with the point within a centimetre and
    // three standard deviations of a depth camera's noise, over the pixels around: an error of the
    // pose by a pixel is no evidence, and neither is what has no depth. Thread-safe.
    Evidence At(const Eigen::Vector3f& p_world) const;

  private:
    struct View {
        Eigen::Isometry3f T_camera_world;
        float fx, fy, cx, cy;  // of the reduced images
        // Millimetres, of the pixels around that have depth; 0 where none has. `nearest` has kGap
        // added where one has none.
        Image<std::uint16_t> nearest, farthest;
    };
    static constexpr std::uint16_t kGap = 0x8000;

    std::vector<View> views_;
};

}  // namespace tessera
