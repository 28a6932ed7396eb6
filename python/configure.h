// A run's configuration as the module's functions take it: what --config and --set are on the
// command line.
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <optional>

#include "system/run_config.h"

namespace tessera::python {

// `config`: a preset's name or a YAML file; then each of `settings`, in its order. Values are str,
// bool, int or float. Throws std::invalid_argument with the line that the program would print.
RunConfig Configure(const std::optional<std::filesystem::path>& config,
                    const std::optional<pybind11::dict>& settings);

}  // namespace tessera::python
