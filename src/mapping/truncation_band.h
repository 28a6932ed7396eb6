// The band around a measured surface in which distances are stored. Host-device.
#pragma once

#include "core/host_device.h"
#include "core/scalar_ops.h"

namespace tessera {

// Depth from stereo and structured light scatters in proportion to its square. Where a band is
// narrower than the scatter, the measurements behind it are dropped and those in front of it are
// clamped: the surface moves backwards, and with it the camera.
struct TruncationBand {
    float least_m, per_m;
    float most_m;  // stored distances are in units of this

    // Half width around a surface at this depth.
    template <class F>
    TESSERA_HD_MEMBER F At(const F& depth_m) const {
        return min(max(F(per_m) * depth_m * depth_m, F(least_m)), F(most_m));
    }
};

}  // namespace tessera
