// Says in one line what a path is, before a run on it: a source, a result, or something else.
#pragma once

#include <string>

#include "system/run_config.h"

namespace tessera {

struct ExaminedPath {
    bool can_run = false;   // tessera run
    bool can_view = false;  // tessera view
    bool failed = false;    // neither, and the text is the error
    std::string text;       // one printable line
};

// `path` as for tessera run. Opens files, but no camera and no pipe. Thread-safe.
ExaminedPath ExaminePath(const std::string& path, const RunConfig& config);

}  // namespace tessera
