// Fusion on the device, with the formulas of mapping/fusion_kernels.h.
#pragma once

#include "cuda/device.h"
#include "mapping/fusion_arguments.h"

namespace tessera::TESSERA_DEVICE {

// The farthest depth of every tile (visibility_kernels.h) of an image on the device.
void BuildDepthTiles(Stream& stream, const float* depth_m, std::int32_t width, std::int32_t height,
                     float* tiles);

// Updates the `count` blocks listed in `blocks` and sets their revision. All arrays, including
// those of the arguments, are on the device.
void FuseBlocks(Stream& stream, const FusionArguments& arguments, const std::int32_t* blocks,
                std::int32_t count, std::uint32_t* revisions, std::uint32_t revision);

}  // namespace tessera::TESSERA_DEVICE
