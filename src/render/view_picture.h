// A measured frame beside what the map predicts for it, as one picture: what a person looks at when
// tracking misbehaves.
#pragma once

#include "core/frame.h"
#include "core/image.h"
#include "mapping/moving_mask.h"
#include "mapping/predicted_view.h"

namespace tessera {

// Two rows of three images of the frame's size, each with its name: measured colour, measured
// depth, measured minus predicted depth (blue: behind the map, red: in front of it, white: equal,
// full colour at 5 cm); predicted colour, predicted depth, predicted intensity minus gain *
// measured - offset (red: the map is brighter, full colour at 0.25). What moves is magenta in the
// measured colour (`moving`: null where nothing does). Where one of both is missing, differences
// are grey. Depth from red (near) to blue (far), black where there is none. The view has the
// frame's size. Thread-safe.
ColourImage ViewPicture(const Frame& frame, const PredictedView& view, double gain, double offset,
                        const MovingMask* moving = nullptr);

}  // namespace tessera
