// A run with its window: the run on a thread of its own, the window on the main one, a ViewerLink
// between them.
#pragma once

#include <atomic>

#include "console.h"
#include "system/run.h"

namespace tessera {

// As ExecuteRun. Where no window can be opened, the console says why and the run goes on without.
Result<RunSummary> ExecuteRunInWindow(RunRequest request, const RunConfig& config, Console& console,
                                      const std::atomic<bool>& stop);

}  // namespace tessera
