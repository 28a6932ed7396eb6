// Recovers the intact content of a damaged scan file into a new file.
#pragma once

#include <string>
#include <vector>

#include "core/status.h"

namespace tessera {

struct RepairReport {
    std::int64_t blocks = 0, path = 0, frames = 0, keyframes = 0;  // numbers recovered
    // What was lost, for the user, one item per line; empty if nothing was.
    std::vector<std::string> lost;
};

// Creates `out`, which is then a valid scan. If several versions of a row are found, takes the
// newest. Errors: `path` cannot be read or holds nothing to recover; `out` exists or cannot be
// written.
Result<RepairReport> RepairScan(const std::string& path, const std::string& out);

}  // namespace tessera
