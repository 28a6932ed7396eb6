// Whether two aligned views show the same texture. Rooms of one kind have the same walls, floor and
// doors, so depth alone cannot tell them apart; what hangs on the walls can.
#pragma once

#include <Eigen/Geometry>

#include "optimize/dense_view.h"

namespace tessera {

// Correlation of the fine texture (intensity less the mean of its surroundings) at the pixels whose
// surface both views see, in [-1, 1]. Gain, offset and slow changes of light do not matter. 0 if
// they share too few pixels. Thread-safe.
double TextureCorrelation(const DenseView& a, const DenseView& b, const Eigen::Isometry3d& T_a_b);

// Either view explains more than half of the variance of the other's fine texture.
inline bool SameTexture(const DenseView& a, const DenseView& b, const Eigen::Isometry3d& T_a_b) {
    const double correlation = TextureCorrelation(a, b, T_a_b);
    return correlation > 0 && correlation * correlation > 0.5;
}

}  // namespace tessera
