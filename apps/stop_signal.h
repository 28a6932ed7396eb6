// Ctrl-C and SIGTERM as a flag that a run checks between frames.
#pragma once

#include <atomic>

namespace tessera {

// Installs the handlers on the first call. The first signal sets the flag; a second one ends the
// program at once.
const std::atomic<bool>& StopOnSignal();

}  // namespace tessera
