// Ray casting of views on the device, and the ICP tracker's model of these views, with the formulas
// of mapping/range_kernels.h, mapping/ray_kernels.h and tracking/model_kernels.h.
#pragma once

#include "cuda/device.h"
#include "mapping/range_kernels.h"
#include "mapping/ray_arguments.h"
#include "tracking/model_kernels.h"

namespace tessera::TESSERA_DEVICE {

// All arrays, including those of the arguments, are on the device.

// RayRanges of a view: one range per tile. `blocks` includes the unknown block; `coords` is
// BlockMapView::coords.
void FindRayRanges(Stream& stream, const RangeArguments& arguments, const std::int32_t* coords,
                   std::int32_t blocks, RayRange* ranges);

// Casts the ray of every pixel and writes to the images of the arguments.
void CastRays(Stream& stream, const RayArguments& arguments, const RayRange* ranges);

// ModelImages::TrustedIntensity of every pixel.
void TrustIntensities(Stream& stream, const ModelImages& view, float jump_m, float* intensity);

// ModelImages::Halved of every pixel of an image of half the size. Writes to images of that size.
void HalveModel(Stream& stream, const ModelImages& fine, float jump_m, float* depth_m,
                float* normal, float* intensity);

}  // namespace tessera::TESSERA_DEVICE
