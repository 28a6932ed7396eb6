// The noise of a depth camera.
#pragma once

namespace tessera {

// Standard deviation of a measurement at depth z_m, metres: axial noise of a structured-light
// sensor (Nguyen et al. 2012).
inline float DepthSigma_m(float z_m) { return 0.0012f + 0.0019f * (z_m - 0.4f) * (z_m - 0.4f); }

}  // namespace tessera
