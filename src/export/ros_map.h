// A floor plan for robots that drive: the 2D map of ROS, as nav2's and ROS 1's map_server read it.
#pragma once

#include <cstdint>
#include <string>

#include "core/image.h"
#include "core/status.h"
#include "export/occupancy.h"

namespace tessera {

struct RosMap {
    struct Options {
        // Heights above the floor, metres, between which obstacles count; from 0 on. Carpets and
        // thresholds lie below, lamps and lintels above.
        double low_m = 0.1, high_m = 1.8;
    };
    // The values of pixels.
    static constexpr std::uint8_t kOccupied = 0, kUnknown = 205, kFree = 254;

    Image<std::uint8_t> pixels;  // row 0 has the largest y
    double resolution_m = 0.05;
    double origin_x_m = 0, origin_y_m = 0;  // the lower left corner of the lower left pixel
};

// The columns of an occupancy whose grid frame has z up and the floor at z = 0. A column is
// occupied if a cell is that begins at `low_m` or above and whose centre is below `high_m`; else
// free if one of these is free or the floor was seen, which is any cell below them that reaches
// above -`low_m`; else unknown. So the floor's own cells are no obstacle, however large they are.
// Requires 0 <= low_m < high_m. Thread-safe.
RosMap MakeRosMap(const Occupancy& occupancy, const RosMap::Options& options);

// Writes NAME.pgm (binary, 8 bits) beside `yaml_path` (NAME.yaml), which is written last. Errors:
// write errors. Thread-safe for different paths. Source: map_server's documentation, trinary mode.
Status WriteRosMap(const std::string& yaml_path, const RosMap& map);

}  // namespace tessera
