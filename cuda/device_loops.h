// Loops over items and sums over them, for bodies that are plain structs with TESSERA_HD_MEMBER operator(). Included only by
// sources that nvcc compiles for a GPU and g++ for the serial device.
#pragma once

#include "core/host_device.h"
#include "cuda/device.h"

#ifdef __CUDACC__
#include "cuda/cuda_check.h"
#endif

namespace tessera::TESSERA_DEVICE {

// Sums are taken in tiles of this many lanes, each of which adds this many items: item = tile * kTileItems + step * kTileLanes
// + lane. Warps of 32 lanes are added as a tree, then the warps, then the tiles, each in its order: the same bytes on every
// run, and on every device.
inline constexpr int kTileLanes = 128, kTileSteps = 4, kTileItems = kTileLanes * kTileSteps;
inline constexpr int kWarpLanes = 32, kTileWarps = kTileLanes / kWarpLanes;

inline int TileCount(int items) { return (items + kTileItems - 1) / kTileItems; }

#ifdef __CUDACC__

namespace loops {

template <class Body>
__global__ void ForEach(int count, Body body) {
    const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
    if (i < count) body(i);
}

template <int kSums, class Body>
__global__ void __launch_bounds__(kTileLanes) SumTile(int count, Body body, double* tiles) {
    const int lane = static_cast<int>(threadIdx.x), tile = static_cast<int>(blockIdx.x);
    float sums[kSums] = {};
    for (int step = 0; step < kTileSteps; ++step) {
        const int item = tile * kTileItems + step * kTileLanes + lane;
        if (item < count) body(item, sums);
    }
    __shared__ float warps[kTileWarps][kSums];
#pragma unroll
    for (int k = 0; k < kSums; ++k) {
        float sum = sums[k];
#pragma unroll
        for (int stride = kWarpLanes / 2; stride > 0; stride /= 2) sum += __shfl_down_sync(0xffffffffu, sum, stride);
        if (lane % kWarpLanes == 0) warps[lane / kWarpLanes][k] = sum;
    }
    __syncthreads();
    for (int k = lane; k < kSums; k += kTileLanes) {
        double sum = 0;
        for (int warp = 0; warp < kTileWarps; ++warp) sum += warps[warp][k];
        tiles[tile * kSums + k] = sum;
    }
}

template <int kSums>
__global__ void AddTiles(int count, const double* tiles, double* sums) {
    const int k = static_cast<int>(threadIdx.x);
    if (k >= kSums) return;
    double sum = 0;
    for (int tile = 0; tile < count; ++tile) sum += tiles[tile * kSums + k];
    sums[k] = sum;
}

}  // namespace loops

// body(i) for i in [0, count), in no order.
template <class Body>
void ForEach(Stream& stream, int count, const Body& body) {
    constexpr int kThreads = 128;
    if (count <= 0) return;
    loops::ForEach<<<(count + kThreads - 1) / kThreads, kThreads, 0, static_cast<cudaStream_t>(stream.handle())>>>(count, body);
    TESSERA_CUDA_CHECK(cudaGetLastError());
}

// body(i, sums) adds what item i has to sums[0] to sums[kSums - 1]. `tiles`: room for TileCount(count) * kSums; `sums`: for
// kSums. Both on the device.
template <int kSums, class Body>
void SumTiles(Stream& stream, int count, const Body& body, double* tiles, double* sums) {
    const auto handle = static_cast<cudaStream_t>(stream.handle());
    if (count > 0) loops::SumTile<kSums><<<TileCount(count), kTileLanes, 0, handle>>>(count, body, tiles);
    constexpr int kThreads = (kSums + kWarpLanes - 1) / kWarpLanes * kWarpLanes;
    loops::AddTiles<kSums><<<1, kThreads, 0, handle>>>(TileCount(count), tiles, sums);
    TESSERA_CUDA_CHECK(cudaGetLastError());
}

#else

template <class Body>
void ForEach(Stream&, int count, const Body& body) {
    for (int i = 0; i < count; ++i) body(i);
}

template <int kSums, class Body>
void SumTiles(Stream&, int count, const Body& body, double*, double* sums) {
    std::fill_n(sums, kSums, 0.0);
    for (int tile = 0; tile < TileCount(count); ++tile) {
        float lanes[kTileLanes][kSums] = {};
        for (int step = 0; step < kTileSteps; ++step)
            for (int lane = 0; lane < kTileLanes; ++lane)
                if (const int item = tile * kTileItems + step * kTileLanes + lane; item < count) body(item, lanes[lane]);
        double tile_sums[kSums] = {};
        for (int warp = 0; warp < kTileWarps; ++warp) {
            auto* lane = lanes + warp * kWarpLanes;
            for (int stride = kWarpLanes / 2; stride > 0; stride /= 2)
                for (int i = 0; i < stride; ++i)
                    for (int k = 0; k < kSums; ++k) lane[i][k] += lane[i + stride][k];
            for (int k = 0; k < kSums; ++k) tile_sums[k] += lane[0][k];
        }
        for (int k = 0; k < kSums; ++k) sums[k] += tile_sums[k];
    }
}

#endif

// Atomic in a loop over items; each returns what was there before.
template <class T>
TESSERA_HD T AtomicAdd(T* at, T value) {
#ifdef __CUDA_ARCH__
    return atomicAdd(at, value);
#else
    return std::exchange(*at, static_cast<T>(*at + value));
#endif
}

// The lesser, or the larger, of `value` and what is there stays there. Both must be at least 0: their bits then sort as they do.
TESSERA_HD void AtomicMin(float* at, float value) {
#ifdef __CUDA_ARCH__
    atomicMin(reinterpret_cast<int*>(at), __float_as_int(value));
#else
    *at = std::min(*at, value);
#endif
}
TESSERA_HD void AtomicMax(float* at, float value) {
#ifdef __CUDA_ARCH__
    atomicMax(reinterpret_cast<int*>(at), __float_as_int(value));
#else
    *at = std::max(*at, value);
#endif
}

// Puts `value` where `expected` is.
template <class T>
TESSERA_HD T AtomicSwapIf(T* at, T expected, T value) {
#ifdef __CUDA_ARCH__
    using Word = std::conditional_t<sizeof(T) == 8, unsigned long long, T>;
    return static_cast<T>(atomicCAS(reinterpret_cast<Word*>(at), static_cast<Word>(expected), static_cast<Word>(value)));
#else
    const T before = *at;
    if (before == expected) *at = value;
    return before;
#endif
}

}  // namespace tessera::TESSERA_DEVICE
