// The few calls that a device answers, as plain functions: device_cuda.cu asks the CUDA runtime,
// device_host.cpp does them in the computer's own memory. Everything else in this folder is written
// once, on top of these, and compiled for both: TESSERA_DEVICE is `cuda` or `host`.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tessera::TESSERA_DEVICE::backend {

// The device broke, or this program used it wrongly: says so and aborts. (nvcc cannot read the
// formatting library.)
[[noreturn]] void Failed(const char* file, int line, const char* expression, const char* reason);

// Null where there is no room.
void* Allocate(std::size_t bytes);
void Free(void* memory);
// The computer's memory, such that copies between it and the device run beside other work.
void* AllocatePinned(std::size_t bytes);
void FreePinned(void* memory);

// Commands given to one stream run in that order. The calls below return before the work is done,
// Synchronise after.
void* MakeStream();
void DestroyStream(void* stream);
void Synchronise(void* stream);
// Any of the two may be pinned memory.
void Copy(void* to, const void* from, std::size_t bytes, void* stream);
void Fill(void* memory, unsigned char value, std::size_t bytes, void* stream);

// Sorts `count` keys into `sorted`, the lowest first. With `scratch` null only says how many bytes
// that takes.
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
