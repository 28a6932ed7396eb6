// Loops over items, and sums over them. Bodies are plain structs with a TESSERA_HD_MEMBER
// operator(). Included only by sources that nvcc compiles for a GPU and g++ for the host device.
#pragma once

#include <atomic>

#include "core/host_device.h"
#include "core/scalar_lanes.h"
#include "core/tile_sums.h"
#include "cuda/device.h"

#ifdef __CUDACC__
#include "cuda/cuda_check.h"
#else
#include "cuda/device_host.h"
#endif

namespace tessera::TESSERA_DEVICE {

inline int TileCount(int items) { return (items + kTileItems - 1) / kTileItems; }
inline int RunCount(int items) { return (items + kRunItems - 1) / kRunItems; }
// Temporary doubles that SumTiles needs.
inline std::size_t TileRoom(int items, int sums) {
    return static_cast<std::size_t>(TileCount(items) + RunCount(items)) *
           static_cast<std::size_t>(sums);
}

#ifdef __CUDACC__

namespace loops {

template <class Body>
__global__ void ForEach(int count, Body body) {
    const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
    if (i < count) body(i);
}

// One warp per tile. Lane i adds its kTileSteps items, then takes part in the tree reduction.
inline constexpr int kTilesPerBlock = 4;
template <int kSums, class Body>
__global__ void __launch_bounds__(kTileLanes* kTilesPerBlock)
    SumTile(int count, Body body, double* tiles) {
    const int lane = static_cast<int>(threadIdx.x) % kTileLanes;
    const int tile =
        static_cast<int>(blockIdx.x) * kTilesPerBlock + static_cast<int>(threadIdx.x) / kTileLanes;
    if (tile * kTileItems >= count) return;  // the whole warp
    float sums[kSums] = {};
    for (int step = 0; step < kTileSteps; ++step) {
        const int item = tile * kTileItems + step * kTileLanes + lane;
        if (item < count) body(item, sums);
    }
#pragma unroll
    for (int k = 0; k < kSums; ++k) {
        float sum = sums[k];
#pragma unroll
        for (int half = kTileLanes / 2; half > 0; half /= 2)
            sum += __shfl_down_sync(0xffffffffu, sum, half);
        if (lane == 0) tiles[tile * kSums + k] = sum;
    }
}

// One block: a thread for each sum of a run, then one for each total. Runs are stored after the
// tiles.
inline constexpr int kAddThreads = 1024;
template <int kSums>
__global__ void __launch_bounds__(kAddThreads)
    AddRuns(int tile_count, int run_count, double* tiles, double* sums) {
    double* runs = tiles + tile_count * kSums;
    for (int i = static_cast<int>(threadIdx.x); i < run_count * kSums; i += kAddThreads) {
        const int run = i / kSums, k = i % kSums;
        const int first = run * kRunTiles,
                  last = first + kRunTiles < tile_count ? first + kRunTiles : tile_count;
        double sum = 0;
        for (int tile = first; tile < last; ++tile) sum += tiles[tile * kSums + k];
        runs[i] = sum;
    }
    __syncthreads();
    const int k = static_cast<int>(threadIdx.x);
    if (k >= kSums) return;
    double sum = 0;
    for (int run = 0; run < run_count; ++run) sum += runs[run * kSums + k];
    sums[k] = sum;
}

}  // namespace loops

// Calls body(i) for i in [0, count), in any order.
template <class Body>
void ForEach(Stream& stream, int count, const Body& body) {
    constexpr int kThreads = 128;
    if (count <= 0) return;
    loops::ForEach<<<(count + kThreads - 1) / kThreads, kThreads, 0,
                     static_cast<cudaStream_t>(stream.handle())>>>(count, body);
    TESSERA_CUDA_CHECK(cudaGetLastError());
}

// body(i, sums) adds the contribution of item i to sums[0] to sums[kSums - 1], in the order of
// core/tile_sums.h. Both arrays are on the device: `tiles` has room for TileRoom(count, kSums),
// `sums` for kSums.
template <int kSums, class Body>
void SumTiles(Stream& stream, int count, const Body& body, double* tiles, double* sums) {
    const auto handle = static_cast<cudaStream_t>(stream.handle());
    const int tile_count = TileCount(count),
              blocks = (tile_count + loops::kTilesPerBlock - 1) / loops::kTilesPerBlock;
    if (blocks > 0)
        loops::SumTile<kSums>
            <<<blocks, kTileLanes * loops::kTilesPerBlock, 0, handle>>>(count, body, tiles);
    loops::AddRuns<kSums>
        <<<1, loops::kAddThreads, 0, handle>>>(tile_count, RunCount(count), tiles, sums);
    TESSERA_CUDA_CHECK(cudaGetLastError());
}

#else

template <class Body>
void ForEach(Stream& stream, int count, const Body& body) {
    constexpr int kPiece = 512;
    backend::Enqueue(stream.handle(), [count, body] {
        backend::InAnyOrder((count + kPiece - 1) / kPiece, [&](int piece) {
            const int first = piece * kPiece;
            for (int i = std::min(first + kPiece, count) - 1; i >= first; --i) body(i);
        });
    });
}

template <int kSums, class Body>
void SumTiles(Stream& stream, int count, const Body& body, double* tiles, double* sums) {
    backend::Enqueue(stream.handle(), [=] {
        double* runs = tiles + TileCount(count) * kSums;
        backend::InAnyOrder(RunCount(count), [&](int run) {
            const int first = run * kRunItems;
            std::fill_n(runs + run * kSums, kSums, 0.0);
            AddTiles<ScalarLanes, kSums>(first, std::min(first + kRunItems, count), body,
                                         runs + run * kSums);
        });
        std::fill_n(sums, kSums, 0.0);
        for (int i = 0; i < RunCount(count) * kSums; ++i) sums[i % kSums] += runs[i];
    });
}

#endif

// Atomic operations for loops over items. AtomicAdd and AtomicSwapIf return the previous value.
template <class T>
TESSERA_HD T AtomicAdd(T* at, T value) {
#ifdef __CUDA_ARCH__
    return atomicAdd(at, value);
#else
    return std::atomic_ref(*at).fetch_add(value);
#endif
}

// Stores the lesser, or the larger, of `value` and the current value. Both must be at least 0,
// because only then do their bits sort like the floats.
TESSERA_HD void AtomicMin(float* at, float value) {
#ifdef __CUDA_ARCH__
    atomicMin(reinterpret_cast<int*>(at), __float_as_int(value));
#else
    const std::atomic_ref shared(*at);
    for (float before = shared; value < before && !shared.compare_exchange_weak(before, value);) {
    }
#endif
}
TESSERA_HD void AtomicMax(float* at, float value) {
#ifdef __CUDA_ARCH__
    atomicMax(reinterpret_cast<int*>(at), __float_as_int(value));
#else
    const std::atomic_ref shared(*at);
    for (float before = shared; value > before && !shared.compare_exchange_weak(before, value);) {
    }
#endif
}

// Stores `value` if the current value is `expected`.
template <class T>
TESSERA_HD T AtomicSwapIf(T* at, T expected, T value) {
#ifdef __CUDA_ARCH__
    using Word = std::conditional_t<sizeof(T) == 8, unsigned long long, T>;
    return static_cast<T>(atomicCAS(reinterpret_cast<Word*>(at), static_cast<Word>(expected),
                                    static_cast<Word>(value)));
#else
    std::atomic_ref(*at).compare_exchange_strong(expected, value);
    return expected;
#endif
}

}  // namespace tessera::TESSERA_DEVICE
