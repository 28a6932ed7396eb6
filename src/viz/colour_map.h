// False colours for the image panels and their legends. Pure functions, thread-safe.
#pragma once

#include <array>

#include "core/camera.h"
#include "core/frame.h"
#include "core/image.h"
#include "mapping/predicted_view.h"

namespace tessera {

// From warm (0) to cool (1); clamped outside [0, 1].
Rgb8 SequentialColour(float value);
// From red (-1) over white (0) to blue (1); clamped outside.
Rgb8 DivergingColour(float value);
// From dark (0) to light (1), for weights (WeightStep / 255); clamped outside. Linear between
// evenly spaced stops.
inline constexpr int kWeightStops = 5;
extern const std::array<Rgb8, kWeightStops> kWeightColours;
Rgb8 WeightColour(float value);
// Colour of pixels without data.
inline constexpr Rgb8 kNothingShown{38, 41, 47};

// Shrinks the image by `step`; each pixel is the mean of a step x step square. step >= 1.
ColourImage ShrinkColour(const ColourImage& image, int step);
// Every `step`-th pixel as a colour: warm is near, cool is `far_m` metres or more, kNothingShown is
// no measurement.
ColourImage DepthColours(const DepthImage& depth_m, float far_m, int step);
// Measured minus predicted depth, in the size of the predicted view: red in front of the map, blue
// behind it, saturated at +- reach_m; kNothingShown where either is missing. `camera`: of the
// frame. Both images must have the same pose.
ColourImage ResidualColours(const DepthImage& measured_m, const PinholeCamera& camera,
                            const PredictedView& predicted, float reach_m);

}  // namespace tessera
