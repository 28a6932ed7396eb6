// SIMD support of this CPU, detected once.
#pragma once

namespace tessera {

// kAuto picks the widest path that both the build and the CPU support. kBaseline forces the
// portable code (tests, benchmarks).
enum class VectorPath { kAuto, kBaseline, kAvx2 };

bool CpuHasAvx2();

}  // namespace tessera
