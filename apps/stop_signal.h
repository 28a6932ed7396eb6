// Ctrl-C and SIGTERM as a flag that a run looks at between frames.
#pragma once

#include <atomic>

namespace tessera {

// From the first call on, the first signal sets the flag and a second one ends the program at once.
const std::atomic<bool>& StopOnSignal();

}  // namespace tessera
