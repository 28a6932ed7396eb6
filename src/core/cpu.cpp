#include "core/cpu.h"

namespace tessera {

bool CpuHasAvx2() {
#if defined(__x86_64__)
    static const bool kHas = __builtin_cpu_supports("avx2");
    return kHas;
#else
    return false;
#endif
}

bool UsesAvx2(VectorPath path) {
    return path == VectorPath::kAvx2 || (path == VectorPath::kAuto && CpuHasAvx2());
}

}  // namespace tessera
