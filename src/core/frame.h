// One RGB-D frame as every stage sees it: rectified, registered, in metres. The holder owns it.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "core/image.h"

namespace tessera {

// What a source adds to a recording's time stamps.
struct StampCorrection {
    double depth_s = 0, colour_s = 0;

    // Colour was taken `colour_delay_s` later than the stamps say. A stamp is given when an image
    // arrives, so it may be late but not early: a positive delay corrects depth's stamps, a
    // negative one colour's. Where the two images of every pair have one stamp (`shared`), whose it
    // is cannot be known, and each gets a half.
    static StampCorrection Of(double colour_delay_s, bool shared) {
        const double depth_share = shared ? 0.5 : colour_delay_s > 0 ? 1.0 : 0.0;
        return {-depth_share * colour_delay_s, (1 - depth_share) * colour_delay_s};
    }
};

struct Frame {
    std::int64_t index = 0;      // 0-based position in the source's list of pairs
    double stamp_s = 0;          // the depth image's time; poses are written at it
    double colour_stamp_s = 0;   // the colour image's time
    StampCorrection correction;  // already in both
    // Ideal pinhole, same size as depth_m. Empty if the source has no colour.
    ColourImage colour;
    DepthImage depth_m;  // ideal pinhole, metres along z, 0 = no measurement
    std::optional<Eigen::Isometry3d> T_world_camera;  // the source's ground truth, if it has one
};

}  // namespace tessera
