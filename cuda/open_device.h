// Entry point to the CUDA backend. Callers need to know nothing else of this folder, nor whether it
// was built.
#pragma once

#include <memory>
#include <string>

#include "core/status.h"
#include "system/backend.h"

namespace tessera {

// One line for the user: the GPUs that are available, or why there is none.
std::string DescribeGpus();

// Opens the first GPU. `memory_limit_mb` 0: uses 90 % of what is free. The error says why there is
// none and what to do.
Result<std::unique_ptr<Backend>> OpenGpu(double memory_limit_mb);

}  // namespace tessera
