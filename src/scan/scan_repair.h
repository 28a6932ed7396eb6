// Recovers what is sound of a damaged scan file into a new one.
#pragma once

#include <string>
#include <vector>

#include "core/status.h"

namespace tessera {

struct RepairReport {
    std::int64_t blocks = 0, path = 0, frames = 0, keyframes = 0;  // recovered
    // For a person, one a line; empty: nothing was.
    std::vector<std::string> lost;
};

// `out` is made anew, and is sound. Rows of which several are found count in their newest form.
// Errors: `path` cannot be read or holds nothing to recover, `out` exists or cannot be written.
Result<RepairReport> RepairScan(const std::string& path, const std::string& out);

}  // namespace tessera
