// --config and --set, shared by every command that has a configuration.
#pragma once

#include <string>
#include <vector>

#include "core/config.h"
#include "core/status.h"

namespace CLI {
class App;
}

namespace tessera {

struct ConfigOptions {
    std::string config;             // name of a preset or file; empty: defaults
    std::vector<std::string> sets;  // KEY=VALUE

    void AddTo(CLI::App& command);
    // Applies the file first, then each --set in the given order.
    Status Apply(ConfigParameters& parameters) const;
};

}  // namespace tessera
