// Sums in a fixed order, so that SIMD of any width, scalar code and a GPU give the same bytes. A
// tile has kTileItems items. Lane i of its kTileLanes lanes adds items i, i + kTileLanes, ... in
// single precision. The lanes are then reduced as a tree: the upper half is added to the lower half
// until one is left. From there on sums are in double precision: the tiles of each run of kRunItems
// items in order, then the runs in order.
#pragma once

#include "core/host_device.h"

namespace tessera {

inline constexpr int kTileLanes = 32, kTileSteps = 8, kTileItems = kTileLanes * kTileSteps;
inline constexpr int kRunTiles = 8, kRunItems = kRunTiles * kTileItems;

// Adds the tiles of items [first, last) to sums[0] to sums[kSums - 1]. add(i, lanes) adds the
// contributions of items [i, i + V::kCount) to `lanes`, one V::Real per sum. `first` is the start
// of a tile. `last` - `first` is a multiple of V::kCount.
template <class V, int kSums, class Add>
TESSERA_HD void AddTiles(int first, int last, const Add& add, double* sums) {
    constexpr int kVectors = kTileLanes / V::kCount;
    static_assert(kVectors * V::kCount == kTileLanes);
    typename V::Real lanes[kVectors][kSums];
    for (int tile = first; tile < last; tile += kTileItems) {
        for (auto& vector : lanes)
            for (auto& sum : vector) sum = typename V::Real(0.0f);
        const int end = tile + kTileItems < last ? tile + kTileItems : last;
        for (int i = tile; i < end; i += V::kCount)
            add(i, lanes[(i - tile) / V::kCount % kVectors]);
        for (int k = 0; k < kSums; ++k) {
            for (int half = kVectors / 2; half > 0; half /= 2)
                for (int v = 0; v < half; ++v) lanes[v][k] = lanes[v][k] + lanes[v + half][k];
            sums[k] += static_cast<double>(V::Sum(lanes[0][k]));
        }
    }
}

}  // namespace tessera
