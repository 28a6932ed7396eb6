// Settings that the user can change during a run. They take effect at the next frame.
#pragma once

#include <optional>
#include <string>

#include "semantics/label_config.h"
#include "system/tracking_method.h"

namespace tessera {

struct ViewerSettings {
    TrackingMethod method = TrackingMethod::kSdf;
    // How often the user has chosen a method. It counts only if this differs from the settings
    // before, because the run itself may have switched the method meanwhile.
    int method_choices = 0;
    bool auto_alpha = true;
    double alpha = 0.03;     // m^2, unless auto_alpha
    double max_depth_m = 5;  // farther measurements are ignored
    bool prealign = true;
    bool fusing = true;  // off: track without changing the map
    // Off: no loop is closed and no lost camera looked for. Empty: so for the whole run.
    std::optional<bool> loops;
    bool show_prediction = true;  // fill ImageUpdate::predicted
    IcpTracker::Prediction prediction = IcpTracker::Prediction::kRayCast;
    LabelSettings labels;  // of a run with labels
    // As for --labels: what to detect objects with from now on. It is opened when `detector_choice`
    // changes, also if it is the same again: it may have failed. Empty: no change.
    std::string detector;
    int detector_choice = 0;  // how many were chosen so far
};

}  // namespace tessera
