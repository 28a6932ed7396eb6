// The GPUs of this machine, as the CUDA runtime lists them.
#pragma once

#include <cstddef>

namespace tessera::TESSERA_DEVICE::backend {

struct Gpu {
    char name[256];
    int major, minor;  // compute capability
    std::size_t free_bytes, total_bytes;
};

// Returns the number of GPUs. `reason` is the runtime's explanation if there are none.
int CountGpus(const char*& reason);
// Makes this GPU the current one and queries it. Returns false if it cannot be used; `reason` says
// why.
bool UseGpu(int index, Gpu& gpu, const char*& reason);

}  // namespace tessera::TESSERA_DEVICE::backend
