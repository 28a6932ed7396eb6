// SIMD support of this CPU, detected once.
#pragma once

namespace tessera {

// kAuto picks the widest path that both the build and the CPU support. kBaseline forces the
// portable code (tests, benchmarks).
enum class VectorPath { kAuto, kBaseline, kAvx2 };

bool CpuHasAvx2();
// Whether `path` means the AVX2 code on this CPU.
bool UsesAvx2(VectorPath path);

}  // namespace tessera

// The build of a SIMD function (tessera_vector_source in cmake/TesseraTargets.cmake) for `path` on
// this CPU: a pointer to avx2::function or baseline::function.
#ifdef TESSERA_HAVE_AVX2
#define TESSERA_SIMD(path, function) (UsesAvx2(path) ? &avx2::function : &baseline::function)
#else
#define TESSERA_SIMD(path, function) (static_cast<void>(path), &baseline::function)
#endif
