// The device that is none: every command is done at once, in the computer's memory. It makes the map and the pipeline
// testable where there is no GPU.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <numeric>

#include "cuda/device_backend.h"

namespace tessera::TESSERA_DEVICE::backend {

void* Allocate(std::size_t bytes) { return std::malloc(std::max<std::size_t>(bytes, 1)); }
void Free(void* memory) { std::free(memory); }
void* AllocatePinned(std::size_t bytes) { return std::malloc(bytes); }
void FreePinned(void* memory) { std::free(memory); }

void* MakeStream() { return nullptr; }
void DestroyStream(void*) {}
void Synchronise(void*) {}
void Copy(void* to, const void* from, std::size_t bytes, void*) { std::memcpy(to, from, bytes); }
void Fill(void* memory, unsigned char value, std::size_t bytes, void*) { std::memset(memory, value, bytes); }

std::size_t SortKeys(const std::uint64_t* keys, std::uint64_t* sorted, int count, void* scratch, std::size_t, void*) {
    if (scratch != nullptr) std::partial_sort_copy(keys, keys + count, sorted, sorted + count);
    return 1;
}

std::size_t SelectIndices(const std::uint8_t* keep, int count, std::int32_t* indices, std::int32_t* selected, void* scratch,
                          std::size_t, void*) {
    if (scratch == nullptr) return 1;
    *selected = 0;
    for (std::int32_t i = 0; i < count; ++i)
        if (keep[i] != 0) indices[(*selected)++] = i;
    return 1;
}

std::size_t SumBefore(const std::int32_t* counts, int count, std::int32_t* sums, void* scratch, std::size_t, void*) {
    if (scratch != nullptr) std::exclusive_scan(counts, counts + count, sums, std::int32_t{0});
    return 1;
}

}  // namespace tessera::TESSERA_DEVICE::backend
