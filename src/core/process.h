// The resources of this process.
#pragma once

namespace tessera {

struct ProcessUsage {
    double cpu_s = 0;        // user and system time of all threads since the process started
    double peak_rss_mb = 0;  // 2^20 bytes
};
// Thread-safe.
ProcessUsage MeasureProcess();

// Returns freed memory to the system, as far as the allocator can. Call before making something
// large. Takes a few milliseconds. Thread-safe.
void ReturnFreeMemory();

}  // namespace tessera
