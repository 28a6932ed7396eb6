// One RGB-D frame as every stage sees it: rectified, registered, in metres. The holder owns it.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "core/image.h"

namespace tessera {

struct Frame {
    std::int64_t index = 0;     // 0-based position in the source's list of pairs
    double stamp_s = 0;         // the depth image's time; poses are written at it
    double colour_stamp_s = 0;  // the colour image's time
    double colour_delay_s = 0;  // by which the source corrected the two (CorrectStamps)
    // Ideal pinhole, same size as depth_m. Empty if the source has no colour.
    ColourImage colour;
    DepthImage depth_m;  // ideal pinhole, metres along z, 0 = no measurement
    std::optional<Eigen::Isometry3d> T_world_camera;  // the source's ground truth, if it has one
};

// Colour was taken `delay_s` later than the time stamps say. Whose are wrong cannot be seen, so
// colour's become later by a half of it and depth's earlier by the other.
inline void CorrectStamps(double delay_s, double& depth_stamp_s, double& colour_stamp_s) {
    depth_stamp_s -= delay_s / 2;
    colour_stamp_s += delay_s / 2;
}

}  // namespace tessera
