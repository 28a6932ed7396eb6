// Stubs for builds without the CUDA backend.
#include "cuda/open_device.h"

namespace tessera {

std::string DescribeGpus() {
    return "off: this build has no CUDA backend; configure with TESSERA_CUDA=ON (needs nvcc)";
}

Result<std::unique_ptr<Backend>> OpenGpu(double) {
    return Status::Error(
        "--device cuda: this build has no CUDA backend; configure with TESSERA_CUDA=ON (needs "
        "nvcc), or omit --device to run on the CPU");
}

}  // namespace tessera
