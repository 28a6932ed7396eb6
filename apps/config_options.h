// --config and --set, the same for every command that has a configuration.
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
    std::string config;             // preset's name or file; empty = the defaults
    std::vector<std::string> sets;  // KEY=VALUE

    void AddTo(CLI::App& command);
    // The file first, then each --set in the order given.
    Status Apply(ConfigParameters& parameters) const;
};

}  // namespace tessera
