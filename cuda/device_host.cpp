// An emulated device in host memory, to test the map and the pipeline without a GPU. It is as
// unforgiving as a GPU: commands run as late as possible, loops run on several threads and
// backwards, and new memory is filled with bytes that are neither a number nor an index. So a
// result that nobody waited for is missing, and a result that depends on thread order or
// uninitialised memory differs from the CPU's. ThreadSanitizer finds the races.
#include "cuda/device_host.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <numeric>
#include <thread>
#include <utility>
#include <vector>

namespace tessera::TESSERA_DEVICE::backend {
namespace {

using Commands = std::vector<std::function<void()>>;

std::mutex streams_mutex;
std::vector<void*> streams;

}  // namespace

void Enqueue(void* stream, std::function<void()> command) {
    static_cast<Commands*>(stream)->push_back(std::move(command));
}

void InAnyOrder(int count, const std::function<void(int)>& piece) {
    constexpr int kThreads = 3;
    std::atomic<int> left = count;
    const auto work = [&] {
        for (int i = left.fetch_sub(1) - 1; i >= 0; i = left.fetch_sub(1) - 1) piece(i);
    };
    std::vector<std::jthread> threads;
    for (int i = 1; i < std::min(count, kThreads); ++i) threads.emplace_back(work);
    work();
}

void* Allocate(std::size_t bytes) {
    void* memory = std::malloc(std::max<std::size_t>(bytes, 1));
    if (memory != nullptr) std::memset(memory, 0xff, bytes);
    return memory;
}

// As with CUDA, all commands finish before memory is freed.
void Free(void* memory) {
    const std::lock_guard lock(streams_mutex);
    for (void* stream : streams) Synchronise(stream);
    std::free(memory);
}

void* AllocatePinned(std::size_t bytes) { return Allocate(bytes); }
void FreePinned(void* memory) { std::free(memory); }

void* MakeStream() {
    const std::lock_guard lock(streams_mutex);
    streams.push_back(new Commands);
    return streams.back();
}

void DestroyStream(void* stream) {
    const std::lock_guard lock(streams_mutex);
    std::erase(streams, stream);
    delete static_cast<Commands*>(stream);
}

void Synchronise(void* stream) {
    for (const auto& command : std::exchange(*static_cast<Commands*>(stream), {})) command();
}

void Copy(void* to, const void* from, std::size_t bytes, void* stream) {
    Enqueue(stream, [=] { std::memcpy(to, from, bytes); });
}

void Fill(void* memory, unsigned char value, std::size_t bytes, void* stream) {
    Enqueue(stream, [=] { std::memset(memory, value, bytes); });
}

std::size_t SortKeys(const std::uint64_t* keys, std::uint64_t* sorted, int count, void* scratch,
                     std::size_t, void* stream) {
    if (scratch != nullptr)
        Enqueue(stream,
                [=] { std::partial_sort_copy(keys, keys + count, sorted, sorted + count); });
    return 1;
}

std::size_t SelectIndices(const std::uint8_t* keep, int count, std::int32_t* indices,
                          std::int32_t* selected, void* scratch, std::size_t, void* stream) {
    if (scratch == nullptr) return 1;
    Enqueue(stream, [=] {
        *selected = 0;
        for (std::int32_t i = 0; i < count; ++i)
            if (keep[i] != 0) indices[(*selected)++] = i;
    });
    return 1;
}

std::size_t SumBefore(const std::int32_t* counts, int count, std::int32_t* sums, void* scratch,
                      std::size_t, void* stream) {
    if (scratch != nullptr)
        Enqueue(stream,
                [=] { std::exclusive_scan(counts, counts + count, sums, std::int32_t{0}); });
    return 1;
}

}  // namespace tessera::TESSERA_DEVICE::backend
