// Included only by sources that nvcc compiles.
#pragma once

#include <cuda_runtime.h>

#include "cuda/device_backend.h"

namespace tessera::TESSERA_DEVICE {

inline void CudaCheck(cudaError_t error, const char* file, int line, const char* expression) {
    if (error != cudaSuccess) backend::Failed(file, line, expression, cudaGetErrorString(error));
}

}  // namespace tessera::TESSERA_DEVICE

#define TESSERA_CUDA_CHECK(expression) \
    ::tessera::TESSERA_DEVICE::CudaCheck((expression), __FILE__, __LINE__, #expression)
