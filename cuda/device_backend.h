// The few calls that a device implements, as plain functions: device_cuda.cu calls the CUDA
// runtime, device_host.cpp emulates a device in host memory. Everything else in this folder is
// written once, on top of these, and compiled for both. TESSERA_DEVICE is `cuda` or `host`.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tessera::TESSERA_DEVICE::backend {

// Reports that the device failed or that this program used it wrongly, and aborts. (nvcc cannot
// compile the formatting library.)
[[noreturn]] void Failed(const char* file, int line, const char* expression, const char* reason);

// Returns null if there is no room.
void* Allocate(std::size_t bytes);
void Free(void* memory);
// Pinned host memory, so that copies between it and the device overlap with other work.
void* AllocatePinned(std::size_t bytes);
void FreePinned(void* memory);

// Commands of one stream run in order. The calls below return before the work is done; Synchronise
// waits for it.
void* MakeStream();
void DestroyStream(void* stream);
void Synchronise(void* stream);
// Either pointer may be pinned memory.
void Copy(void* to, const void* from, std::size_t bytes, void* stream);
void Fill(void* memory, unsigned char value, std::size_t bytes, void* stream);

// Sorts `count` keys into `sorted`, lowest first. With `scratch` null, only returns the bytes of
// scratch needed.
std::size_t SortKeys(const std::uint64_t* keys, std::uint64_t* sorted, int count, void* scratch,
                     std::size_t scratch_bytes, void* stream);
// Writes the indices i with keep[i] != 0 in increasing order, and how many there are. `scratch` as
// above.
std::size_t SelectIndices(const std::uint8_t* keep, int count, std::int32_t* indices,
                          std::int32_t* selected, void* scratch, std::size_t scratch_bytes,
                          void* stream);
// sums[i] = counts[0] + ... + counts[i - 1]. `scratch` as above.
std::size_t SumBefore(const std::int32_t* counts, int count, std::int32_t* sums, void* scratch,
                      std::size_t scratch_bytes, void* stream);

}  // namespace tessera::TESSERA_DEVICE::backend
