// Ctrl-C, SIGTERM and the end of the terminal (SIGHUP) as a flag that a run checks between frames.
#pragma once

#include <atomic>

namespace tessera {

// Installs the handlers on the first call. The first signal sets the flag; the same one again ends
// the program at once. A signal that the caller ignores (nohup) stays ignored. A closed pipe on
// stdout or stderr no longer ends the program.
const std::atomic<bool>& StopOnSignal();

}  // namespace tessera
