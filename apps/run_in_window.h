// A run with its window: the run on its own thread, the window on the main thread, connected by a
// ViewerLink.
#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include "console.h"
#include "run/run.h"

namespace tessera {

class Window;

// A window that is there already, as in CommandContext.
struct GivenWindow {
    std::shared_ptr<Window> window;       // null: the run opens its own
    std::function<bool()> while_opening;  // false: it was closed; may be empty
};

// Like ExecuteRun. If no window can be opened, the console says why and the run continues without
// one.
Result<RunSummary> ExecuteRunInWindow(RunRequest request, const RunConfig& config, Console& console,
                                      const std::atomic<bool>& stop, const GivenWindow& given = {});

}  // namespace tessera
