// A run with its window: the run on its own thread, the window on the main thread, connected by a
// ViewerLink.
#pragma once

#include <atomic>

#include "console.h"
#include "run/run.h"

namespace tessera {

// Like ExecuteRun. If no window can be opened, the console says why and the run continues without
// one.
Result<RunSummary> ExecuteRunInWindow(RunRequest request, const RunConfig& config, Console& console,
                                      const std::atomic<bool>& stop);

}  // namespace tessera
