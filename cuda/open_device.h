// The CUDA backend's door: whoever comes through it needs to know nothing else of this folder, nor
// whether it was built.
#pragma once

#include <memory>
#include <string>

#include "system/device.h"

namespace tessera {

// One line for a person: the GPUs that are here, or why there is none.
std::string DescribeGpus();

// The first GPU. An error says why there is none, and what to do.
Result<std::unique_ptr<Device>> OpenGpu(const DeviceConfig& config);

}  // namespace tessera
