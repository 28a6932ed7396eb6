#include <cuda_runtime.h>

#include <cstring>

#include "cuda/gpus.h"

namespace tessera::TESSERA_DEVICE::backend {

int CountGpus(const char*& reason) {
    int count = 0;
    const cudaError_t error = cudaGetDeviceCount(&count);
    (void)cudaGetLastError();
    // The runtime's error if there is no driver at all.
    const bool no_driver = error == cudaErrorInsufficientDriver;
    reason = no_driver ? "no NVIDIA driver, or it is too old for this CUDA toolkit"
                       : cudaGetErrorString(error);
    if (error == cudaSuccess) reason = "the driver reports no GPU";
    return error == cudaSuccess ? count : 0;
}

bool UseGpu(int index, Gpu& gpu, const char*& reason) {
    cudaDeviceProp properties;
    cudaError_t error = cudaGetDeviceProperties(&properties, index);
    if (error == cudaSuccess) error = cudaSetDevice(index);
    if (error == cudaSuccess) error = cudaMemGetInfo(&gpu.free_bytes, &gpu.total_bytes);
    reason = cudaGetErrorString(error);
    (void)cudaGetLastError();
    if (error != cudaSuccess) return false;
    std::strncpy(gpu.name, properties.name, sizeof gpu.name - 1);
    gpu.name[sizeof gpu.name - 1] = 0;
    gpu.major = properties.major;
    gpu.minor = properties.minor;
    return true;
}

}  // namespace tessera::TESSERA_DEVICE::backend
