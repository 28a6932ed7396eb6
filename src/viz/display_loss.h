// What X11's client library does when the display server goes away is to end the process; a running
// scan must not end like that.
#pragma once

namespace tessera {

// After the window is made, on its thread: from now on errors of X11 do not end the process, and
// the loss of the connection is what DisplayIsLost tells. Does nothing on other window systems, and
// with libX11 before 1.7 the loss still ends the process.
void SurviveLossOfDisplay();
bool DisplayIsLost();

}  // namespace tessera
