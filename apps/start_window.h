// The start screen of `tessera view`: what is chosen there is done as if its command line had been
// typed.
#pragma once

namespace tessera {

struct CommandContext;

// Returns the exit code of what was chosen; kExitDone if the window is closed before. What is
// refused is said in the window, and something else can be chosen.
int StartInWindow(const CommandContext& context, int width, int height);

}  // namespace tessera
