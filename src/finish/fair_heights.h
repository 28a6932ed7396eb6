// A smooth height field over a triangulated polygon that continues the surface around it.
#pragma once

#include <span>
#include <vector>

#include "finish/polygon_mesh.h"

namespace tessera {

// Heights of all points: those of the polygon's `rim` stay, and the inner ones bend the surface as
// little as possible, from the rim's slopes on: the least sum of the squared jumps of the slope
// across the edges, which is a thin plate's energy. `slopes`: d height / d x, d y of the
// surroundings, one per corner of the polygon, or empty if they are not known. Planes come out
// exactly. None if the equations cannot be solved. Thread-safe.
std::optional<std::vector<double>> FairHeights(const PolygonMesh& mesh, std::span<const double> rim,
                                               std::span<const Eigen::Vector2d> slopes);

}  // namespace tessera
