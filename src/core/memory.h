// How much memory this process can still take.
#pragma once

#include <cstddef>
#include <string>

namespace tessera {

// In MB (2^20 bytes): the least of what the machine has available, what the limits of the process's
// control groups (a container's memory limit) leave, and what SetMemoryLimit leaves. Takes a tenth
// of a millisecond. Thread-safe. `root`: where /proc and /sys are; for tests.
double FreeMemoryMb(const std::string& root = "");

// True if this much can be taken and a reserve is left. Thread-safe.
bool MemoryHasRoomFor(std::size_t bytes);

// The process's memory that counts as its own limit, in MB; 0: none. Thread-safe.
void SetMemoryLimit(double limit_mb);

}  // namespace tessera
