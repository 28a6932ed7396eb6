// Which vector instructions this machine has; asked once at start.
#pragma once

namespace tessera {

// kAuto picks the widest that the build and the machine have; kBaseline forces the portable code
// (tests, bench).
enum class VectorPath { kAuto, kBaseline, kAvx2 };

bool CpuHasAvx2();

}  // namespace tessera
