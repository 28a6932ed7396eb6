// How much memory a map will take, before there is one.
#pragma once

#include "mapping/voxel.h"

namespace tessera {

// Bytes of voxels per square metre of surface. Along the surface's normal, the band of 2 x
// truncation touches its own length in blocks and two more: one because it begins anywhere in a
// block, one for slanted surfaces, noise and the neighbours that tracking needs. On recordings of
// rooms with furniture and a truncation of 4 voxels, within a factor of 1.3.
inline double MapBytesPerSquareMetre(double voxel_size_m, double truncation_m) {
    constexpr double kBytesPerVoxel = 10.2;
    const double block_m = kBlockSide * voxel_size_m;
    const double blocks = (2 * truncation_m / block_m + 2) / (block_m * block_m);
    return kBlockVoxels * kBytesPerVoxel * blocks;
}

}  // namespace tessera
