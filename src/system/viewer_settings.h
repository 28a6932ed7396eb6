// What a person may change while the system runs, in force from the next frame on.
#pragma once

#include "system/tracking_method.h"

namespace tessera {

struct ViewerSettings {
    TrackingMethod method = TrackingMethod::kSdf;
    bool auto_alpha = true;
    double alpha = 0.03;     // m^2, unless auto_alpha
    double max_depth_m = 5;  // farther measurements are left out
    bool prealign = true;
    bool fusing = true;           // off: track, but leave the map as it is
    bool show_prediction = true;  // fill ImageUpdate::predicted
};

}  // namespace tessera
