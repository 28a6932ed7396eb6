// Read-out time of an image row under a rolling shutter. Shared by CPU and CUDA code.
#pragma once

#include "core/host_device.h"

namespace tessera {

// Seconds from the read-out of the middle row to that of `row`. readout_s is the time from the
// first row to the last.
TESSERA_HD double RowTime(double readout_s, double row, int height) {
    return readout_s * (row / height - 0.5);
}

}  // namespace tessera
