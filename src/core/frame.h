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
    // Ideal pinhole, same size as depth_m. Empty if the source has no colour.
    ColourImage colour;
    DepthImage depth_m;  // ideal pinhole, metres along z, 0 = no measurement
    std::optional<Eigen::Isometry3d> T_world_camera;  // the source's ground truth, if it has one
};

}  // namespace tessera
