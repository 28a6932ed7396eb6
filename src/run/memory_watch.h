// Ends a run in order before memory is used up, and says beforehand how far memory lasts.
#pragma once

#include <optional>
#include <string>

#include "core/stopwatch.h"
#include "system/mapping_stage.h"
#include "system/run_config.h"

namespace tessera {

// A warning if the free memory does not last for a furnished room with voxels of this size; empty
// if it does, or if blocks can leave memory.
std::string MemoryWarning(const RunConfig& config);

// Owner thread only.
class MemoryWatch {
  public:
    explicit MemoryWatch(const RunConfig& config) : loops_(config.loops.enabled) {}

    // Call it after each frame. `refused`: new blocks were, for want of memory. Once, when that
    // happens, or what is free no longer exceeds what the end of the run needs, it returns why the
    // run must end.
    std::optional<std::string> Check(const MapStatistics& map, bool refused);

  private:
    const bool loops_;
    bool told_ = false;
    Stopwatch since_check_;
};

}  // namespace tessera
