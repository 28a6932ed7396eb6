// A box in the world that limits the growth of the map, as in systems with a dense grid ([D18]
// section 4).
#pragma once

#include "core/config.h"
#include "mapping/allocation_kernels.h"

namespace tessera {

struct MapVolume {
    bool bounded = false;
    // World frame, metres.
    double min_x_m = -2.5, min_y_m = -1.1, min_z_m = 0.3;
    double max_x_m = 0.5, max_y_m = 0.9, max_z_m = 3.3;

    void Describe(ConfigParameters& parameters);
    // The error names the axis whose maximum is not above its minimum.
    Status Validate() const;

    WorldBox box() const {
        return {bounded, {min_x_m, min_y_m, min_z_m}, {max_x_m, max_y_m, max_z_m}};
    }
    // Whether the block overlaps the box.
    bool Meets(const BlockCoord& block, double block_m) const {
        return tessera::Meets(box(), block, block_m);
    }
};

}  // namespace tessera
