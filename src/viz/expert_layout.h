// Where the parts of the expert view are. Pure function.
#pragma once

#include "viz/viewer.h"

namespace tessera {

struct ExpertLayout {
    ControlRect left, view, plots, images;  // of a running system
    ControlRect time_line;                  // of a finished run
};

// For a window of this size. `time_line`: its height; 0: none. Without a system, left, plots and
// images are empty.
ExpertLayout LayOutExpert(float width, float height, bool with_system, float time_line);

}  // namespace tessera
