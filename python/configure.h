// The configuration as Python arguments: the equivalents of --config and --set.
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <optional>

#include "system/run_config.h"

namespace tessera::python {

// `config`: a preset's name or a YAML file. Then applies each of `settings`, in order. Values are
// str, bool, int or float. Throws std::invalid_argument with the message that the program would
// print.
RunConfig Configure(const std::optional<std::filesystem::path>& config,
                    const std::optional<pybind11::dict>& settings);

}  // namespace tessera::python
