// Camera motion during one frame, to first order in time. The images of a frame are not captured at
// one instant: colour and depth have their own time stamps, and a rolling shutter reads the rows
// one after another.
#pragma once

#include "core/row_time.h"
#include "core/se3.h"

namespace tessera {

struct FrameMotion {
    // Body twist per second: T_world_camera(t + dt) = T_world_camera(t) * Se3Exp(dt * twist_per_s).
    Vector6d twist_per_s = Vector6d::Zero();
    double colour_delay_s = 0;   // the colour image's time minus the depth image's
    double depth_readout_s = 0;  // from the first row to the last, 0 for a global shutter
    double colour_readout_s = 0;

    // Seconds from the frame's reference time (middle row of the depth image) to the given row.
    double DepthTime(double row, int height) const { return RowTime(depth_readout_s, row, height); }
    double ColourTime(double row, int height) const {
        return colour_delay_s + RowTime(colour_readout_s, row, height);
    }
};

}  // namespace tessera
