// Connected regions of tiles: noise makes specks, things make regions.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/camera.h"
#include "core/image.h"

namespace tessera {

// Of marked tiles, those in regions that count.
struct RegionRule {
    // Of the surface, seen face on; what is nearer than 1 m counts as if it were there.
    double min_area_m2 = 0;
    double min_seed_fraction = 0;  // of the region's tiles
};

// Whether 3 x 3 tiles are marked somewhere.
bool HasCore(const Image<std::uint8_t>& marks);

// Keeps the regions of `marks` whose neighbours' depths differ little, that are large enough, hold
// enough of `seeds` and a core of 3 x 3 of them; the others' marks go. `camera` is the tiles'.
void KeepRegions(const DepthImage& depth_m, const Image<std::uint8_t>& seeds,
                 const PinholeCamera& camera, const RegionRule& rule, Image<std::uint8_t>& marks);

// Marks neighbours of marked tiles, and theirs, that `allowed` marks and whose depths differ by
// less than 0.2 m: about as far as `reach_m`.
void GrowRegions(const DepthImage& depth_m, const Image<std::uint8_t>& allowed,
                 const PinholeCamera& camera, double reach_m, Image<std::uint8_t>& marks);

// Marks tiles at most `reach` from where `other_m` has much the same depth, not 0.
void MarkBeside(const DepthImage& depth_m, const DepthImage& other_m, int reach,
                Image<std::uint8_t>& marks);

// Marks all within `reach` tiles of a marked one.
void Dilate(int reach, Image<std::uint8_t>& marks);

}  // namespace tessera
