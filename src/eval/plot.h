// Pictures of evaluations: two trajectories with their error, and the colour scale of a mesh's.
#pragma once

#include <string>

#include "core/image.h"
#include "eval/ate.h"

namespace tessera {

// Both paths from above (where the reference's z is up) and from two sides, and the error over
// time. 1280 x 960. There must be pairs. `title` is ASCII. Thread-safe.
ColourImage PlotAte(const AteResult& result, const std::string& title);

// Draws the scale of ErrorColours(.., max_m) into the picture's lower left corner, in millimetres.
void DrawErrorScale(double max_m, ColourImage& image);

}  // namespace tessera
