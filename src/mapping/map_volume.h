// A box of the world outside of which the map is not to grow, as systems with a dense grid have one ([D18] section 4).
#pragma once

#include "core/config.h"
#include "mapping/voxel.h"

namespace tessera {

struct MapVolume {
    bool bounded = false;
    // World frame, metres.
    double min_x_m = -2.5, min_y_m = -1.1, min_z_m = 0.3;
    double max_x_m = 0.5, max_y_m = 0.9, max_z_m = 3.3;

    void Describe(ConfigParameters& parameters);
    // The error names the axis whose maximum is not above its minimum.
    Status Validate() const;

    // Whether some of the block lies inside.
    bool Meets(const BlockCoord& block, double block_m) const {
        const auto overlap = [&](std::int32_t index, double low, double high) {
            return index * block_m < high && (index + 1) * block_m > low;
        };
        return !bounded || (overlap(block.x, min_x_m, max_x_m) && overlap(block.y, min_y_m, max_y_m) &&
                            overlap(block.z, min_z_m, max_z_m));
    }
};

}  // namespace tessera
