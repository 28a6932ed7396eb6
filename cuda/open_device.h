// Entry point to the CUDA backend. Callers need to know nothing else of this folder, nor whether it
// was built.
#pragma once

#include <memory>
#include <string>

#include "system/backend.h"

namespace tessera {

// One line for the user: the GPUs that are available, or why there is none.
std::string DescribeGpus();

// Opens the first GPU. The error says why there is none and what to do.
Result<std::unique_ptr<Backend>> OpenGpu(const DeviceConfig& config);

}  // namespace tessera
