// A picture that compares a measured frame with the map's prediction, to diagnose tracking
// problems.
#pragma once

#include "core/frame.h"
#include "core/image.h"
#include "mapping/moving_mask.h"
#include "mapping/predicted_view.h"

namespace tessera {

// Two rows of three labelled images of the frame's size. First row: measured colour, measured
// depth, predicted minus measured depth (red: in front of the map, blue: behind it, white: equal,
// full colour at 5 cm). Second row: predicted colour, predicted depth, predicted intensity minus
// (gain * measured + offset) (red: the map is brighter, full colour at 0.25). Moving pixels are
// magenta in the measured colour (`moving`: null if nothing moves). Differences are grey where
// either value is missing. Depth runs from red (near) to blue (far), black where there is none. The
// view must have the frame's size. Thread-safe.
ColourImage ViewPicture(const Frame& frame, const PredictedView& view, double gain, double offset,
                        const MovingMask* moving = nullptr);

}  // namespace tessera
