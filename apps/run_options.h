// The options of `tessera run`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "config_options.h"
#include "run/run.h"

namespace tessera {

struct RunArguments {
    RunRequest request;
    ConfigOptions config;
    std::string tracker, alpha, loop_closure;
    int threads = -1;
    std::string device = "auto", mode = "auto", labels = "none", scan, resume, localise_only;

    // The existing scan to start from; empty if there is none.
    const std::string& existing() const { return resume.empty() ? localise_only : resume; }

    std::vector<std::string> switches;
    bool view = false;
};

// Adds the options to the command. They are stored in `arguments`, which must outlive the parsing.
void AddRunOptions(CLI::App& command, RunArguments& arguments);

// "FRAME:METHOD"
Result<MethodSwitch> ParseSwitch(const std::string& text);

// Sets the configuration first, then the options that correspond to a single key.
Status Configure(const RunArguments& arguments, RunConfig& config);

}  // namespace tessera
