// Settings of OpenNI2 cameras and recordings.
#pragma once

#include "core/config.h"
#include "core/status.h"

namespace tessera {

struct OpenniConfig {
    enum class Playback { kFast, kRecorded };

    // Pixels; 0: from the device's fields of view, and the image's centre.
    double fx = 0, fy = 0, cx = 0, cy = 0;
    bool registration = true;  // depth as the colour camera sees it, by the device
    bool frame_sync = true;    // both images at the same moment, by the device
    bool auto_exposure = true, auto_white_balance = true;
    // Colour and depth at least this far apart in time are no pair.
    double max_pair_gap_s = 0.02;
    Playback playback = Playback::kFast;  // of .oni files

    void Describe(ConfigParameters& parameters);
};

}  // namespace tessera
