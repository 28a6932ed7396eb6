// Connected regions of tiles. Noise forms specks, objects form larger regions.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/camera.h"
#include "core/image.h"

namespace tessera {

// Which regions of marked tiles count.
struct RegionRule {
    // Area of the surface, seen face on. A surface nearer than 1 m counts as if it were at 1 m.
    double min_area_m2 = 0;
    double min_seed_fraction = 0;  // fraction of the region's tiles
};

// Whether 3 x 3 adjacent tiles are marked anywhere.
bool HasCore(const Image<std::uint8_t>& marks);

// Keeps the regions of `marks` that are large enough and contain enough `seeds` and a core of 3 x 3
// seeds. Clears all other marks. Neighbours belong to one region if their depths differ little.
// `camera` is that of the tile image.
void KeepRegions(const DepthImage& depth_m, const Image<std::uint8_t>& seeds,
                 const PinholeCamera& camera, const RegionRule& rule, Image<std::uint8_t>& marks);

// Grows the marked regions, up to about `reach_m`, into neighbours that `allowed` marks and whose
// depths differ by less than 0.2 m.
void GrowRegions(const DepthImage& depth_m, const Image<std::uint8_t>& allowed,
                 const PinholeCamera& camera, double reach_m, Image<std::uint8_t>& marks);

// Marks tiles at most `reach` from a tile where `other_m` is not 0 and has much the same depth.
void MarkNear(const DepthImage& depth_m, const DepthImage& other_m, int reach,
              Image<std::uint8_t>& marks);

// Marks all tiles within `reach` tiles of a marked one.
void Dilate(int reach, Image<std::uint8_t>& marks);

}  // namespace tessera
