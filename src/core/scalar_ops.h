// The few operations that shared kernel templates call by unqualified name, for plain floats. For
// SIMD vectors, argument-dependent lookup finds the same names in the vector library, hence the
// lower case.
#pragma once

#include <cmath>

#include "core/host_device.h"

namespace tessera {

TESSERA_HD float max(float a, float b) { return a > b ? a : b; }
TESSERA_HD float min(float a, float b) { return a < b ? a : b; }
TESSERA_HD float abs(float a) { return std::fabs(a); }
TESSERA_HD float select(bool condition, float a, float b) { return condition ? a : b; }

}  // namespace tessera
