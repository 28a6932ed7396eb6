// Images of evaluation results: two trajectories with their error, and the colour scale of mesh
// errors.
#pragma once

#include <string>

#include "core/image.h"
#include "eval/ate.h"

namespace tessera {

// Plots both paths from above (the reference's z is up) and from two sides, and the error over
// time. 1280 x 960 pixels. There must be at least one pair. `title` must be ASCII. Thread-safe.
ColourImage PlotAte(const AteResult& result, const std::string& title);

// Draws the scale of ErrorColours(.., max_m), in millimetres, into the lower left corner of the
// image.
void DrawErrorScale(double max_m, ColourImage& image);

}  // namespace tessera
