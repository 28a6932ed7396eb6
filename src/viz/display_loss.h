// Keeps the process alive when the display server goes away. By default X11's client library ends
// the process, which would lose a running scan.
#pragma once

namespace tessera {

// Call after the window was made, on its thread. From then on X11 errors do not end the process,
// and DisplayIsLost reports the loss of the connection. Does nothing on other window systems. With
// libX11 before 1.7 a lost connection still ends the process.
void HandleDisplayLoss();
bool DisplayIsLost();

}  // namespace tessera
