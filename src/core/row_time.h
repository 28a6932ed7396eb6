// When a rolling shutter reads a row. Host-device, shared by the CPU and CUDA.
#pragma once

#include "core/host_device.h"

namespace tessera {

// Seconds from the read-out of an image's middle row to that of `row`; readout_s: from the first
// row to the last.
TESSERA_HD double RowTime(double readout_s, double row, int height) {
    return readout_s * (row / height - 0.5);
}

}  // namespace tessera
