// Settings for OpenNI2 cameras and recordings.
#pragma once

#include <string>

#include "core/config.h"
#include "core/status.h"

namespace tessera {

struct OpenniConfig {
    enum class Playback { kFast, kRecorded };

    // In pixels. 0 = from the device's field of view and the image centre.
    double fx = 0, fy = 0, cx = 0, cy = 0;
    // A camera file; "": that of the camera's serial number, if there is one; "none".
    std::string calibration;
    bool registration = true;  // the device registers depth to the colour camera
    bool frame_sync = true;    // the device captures both images at the same time
    bool auto_exposure = true, auto_white_balance = true;
    // Colour and depth images at least this far apart in time are not paired.
    double max_pair_gap_s = 0.02;
    Playback playback = Playback::kFast;  // for .oni files

    void Describe(ConfigParameters& parameters);
};

}  // namespace tessera
