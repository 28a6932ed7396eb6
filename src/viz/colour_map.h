// False colours of the image panels and their legends. Pure functions, thread-safe.
#pragma once

#include <array>

#include "core/camera.h"
#include "core/frame.h"
#include "core/image.h"
#include "mapping/predicted_view.h"

namespace tessera {

// From warm (0) to cool (1); outside [0, 1] as at its ends.
Rgb8 SequentialColour(float value);
// From red (-1) over white (0) to blue (1); outside as at its ends.
Rgb8 DivergingColour(float value);
// From dark (0) to light (1), for weights (WeightStep / 255); outside as at its ends. Between the
// stops, which are evenly spaced, it runs straight.
inline constexpr int kWeightStops = 5;
extern const std::array<Rgb8, kWeightStops> kWeightColours;
Rgb8 WeightColour(float value);
// Where there is nothing to show.
inline constexpr Rgb8 kNothingShown{38, 41, 47};

// Every `step`-th pixel in either direction, the mean of its step x step square. step >= 1.
ColourImage ShrinkColour(const ColourImage& image, int step);
// Every `step`-th pixel: near is warm, far_m metres and more is cool, no measurement is
// kNothingShown.
ColourImage DepthColours(const DepthImage& depth_m, float far_m, int step);
// Measured minus predicted depth, of the predicted view's size: red in front of the map, blue
// behind it, in full colour at +- reach_m; kNothingShown where either is missing. `camera` is the
// frame's; both look from the same pose.
ColourImage ResidualColours(const DepthImage& measured_m, const PinholeCamera& camera,
                            const PredictedView& predicted, float reach_m);

}  // namespace tessera
