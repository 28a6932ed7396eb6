// Finds the nearest of many points for every cell of a box, by lower envelopes of parabolas along
// one axis after the other (Felzenszwalb and Huttenlocher 2012).
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tessera {

// Per cell of the box of `size` cells whose lowest cell is `first`, [z][y][x], the distance from
// its centre to the nearest point, in cells, at most `most`. The unit of `points` is a cell, their
// coordinates are not negative, and they may lie outside of the box. A distance is never too small;
// it may be up to half a cell too large, because the point that is found may not be the nearest.
// Takes 12 bytes per point and 16 per cell of the box, as high as the points reach. Uses all TBB
// threads; the same bytes for any number. Thread-safe. May throw std::bad_alloc.
std::vector<float> NearestPoints(const std::vector<Eigen::Vector3f>& points,
                                 const Eigen::Vector3i& first, const Eigen::Vector3i& size,
                                 float most);

}  // namespace tessera
