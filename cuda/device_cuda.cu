// The GPU backend. An error here is a bug, or a GPU that failed or was removed. The program cannot
// continue, and the message is the driver's.
#include <cuda_runtime.h>
#include <thrust/iterator/counting_iterator.h>

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>
#include <cub/device/device_select.cuh>

#include "cuda/cuda_check.h"
#include "cuda/device_backend.h"

namespace tessera::TESSERA_DEVICE::backend {

void* Allocate(std::size_t bytes) {
    void* memory = nullptr;
    const cudaError_t error = cudaMalloc(&memory, bytes > 0 ? bytes : 1);
    if (error != cudaErrorMemoryAllocation) TESSERA_CUDA_CHECK(error);
    (void)cudaGetLastError();  // no room is a result, not an error to find later
    return error == cudaSuccess ? memory : nullptr;
}

void Free(void* memory) { TESSERA_CUDA_CHECK(cudaFree(memory)); }

void* AllocatePinned(std::size_t bytes) {
    void* memory = nullptr;
    TESSERA_CUDA_CHECK(cudaMallocHost(&memory, bytes));
    return memory;
}

void FreePinned(void* memory) { TESSERA_CUDA_CHECK(cudaFreeHost(memory)); }

void* MakeStream() {
    cudaStream_t stream;
    TESSERA_CUDA_CHECK(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking));
    return stream;
}

void DestroyStream(void* stream) {
    TESSERA_CUDA_CHECK(cudaStreamDestroy(static_cast<cudaStream_t>(stream)));
}

void Synchronise(void* stream) {
    TESSERA_CUDA_CHECK(cudaStreamSynchronize(static_cast<cudaStream_t>(stream)));
}

void Copy(void* to, const void* from, std::size_t bytes, void* stream) {
    TESSERA_CUDA_CHECK(
        cudaMemcpyAsync(to, from, bytes, cudaMemcpyDefault, static_cast<cudaStream_t>(stream)));
}

void Fill(void* memory, unsigned char value, std::size_t bytes, void* stream) {
    TESSERA_CUDA_CHECK(cudaMemsetAsync(memory, value, bytes, static_cast<cudaStream_t>(stream)));
}

std::size_t SortKeys(const std::uint64_t* keys, std::uint64_t* sorted, int count, void* scratch,
                     std::size_t scratch_bytes, void* stream) {
    TESSERA_CUDA_CHECK(cub::DeviceRadixSort::SortKeys(scratch, scratch_bytes, keys, sorted, count,
                                                      0, 64, static_cast<cudaStream_t>(stream)));
    return scratch_bytes;
}

std::size_t SelectIndices(const std::uint8_t* keep, int count, std::int32_t* indices,
                          std::int32_t* selected, void* scratch, std::size_t scratch_bytes,
                          void* stream) {
    TESSERA_CUDA_CHECK(cub::DeviceSelect::Flagged(
        scratch, scratch_bytes, thrust::counting_iterator<std::int32_t>(0), keep, indices, selected,
        count, static_cast<cudaStream_t>(stream)));
    return scratch_bytes;
}

std::size_t SumBefore(const std::int32_t* counts, int count, std::int32_t* sums, void* scratch,
                      std::size_t scratch_bytes, void* stream) {
    TESSERA_CUDA_CHECK(cub::DeviceScan::ExclusiveSum(scratch, scratch_bytes, counts, sums, count,
                                                     static_cast<cudaStream_t>(stream)));
    return scratch_bytes;
}

}  // namespace tessera::TESSERA_DEVICE::backend
