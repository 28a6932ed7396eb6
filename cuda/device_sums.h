// The trackers' normal equations on the device, with the formulas of tracking/sdf_kernels.h and
// icp_kernels.h.
#pragma once

#include "cuda/device.h"
#include "tracking/icp_arguments.h"
#include "tracking/sdf_arguments.h"

namespace tessera::TESSERA_DEVICE {

// Doubles that `tiles` needs for the sums over this many points.
std::size_t TilesOfPoints(int points);

// Writes the sums (SumLayout) over the points to sums[]: the same bytes on every run. All arrays,
// including those of the arguments, are on the device.
void SumSdfPoints(Stream& stream, const SdfArguments& arguments, int points, double* tiles,
                  double* sums);
void SumIcpPoints(Stream& stream, const IcpArguments& arguments, int points, double* tiles,
                  double* sums);

}  // namespace tessera::TESSERA_DEVICE
