// Sums over items in one order, whatever adds them up: vectors of any width, plain numbers, a GPU.
// So all of them give the same bytes. A tile has kTileItems items; lane i of its kTileLanes adds
// items i, i + kTileLanes, ... in single precision; the lanes are added as a tree: the upper half
// to the lower half, until one is left. From there on in double: the tiles of a run of kRunItems in
// their order, then the runs in theirs.
#pragma once

#include "core/host_device.h"

namespace tessera {

inline constexpr int kTileLanes = 32, kTileSteps = 8, kTileItems = kTileLanes * kTileSteps;
inline constexpr int kRunTiles = 8, kRunItems = kRunTiles * kTileItems;

// Adds the tiles of items [first, last) to sums[0] to sums[kSums - 1]. add(i, lanes) adds what
// items [i, i + V::kCount) have to `lanes`, a V::Real for each sum; `first` is a tile's, `last` -
// first a multiple of V::kCount.
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
