// Device services for the map and the pipeline: memory, a command stream, sorting, selection and
// prefix sums. Loops over items are in device_loops.h. Contains no CUDA types, because sources
// compiled by g++ include it, too. Owner thread only.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "cuda/device_backend.h"

namespace tessera::TESSERA_DEVICE {

// Runs commands in order. Copies from and to the host go through the stream's own pinned memory, so
// that they overlap with other work. The source of an Upload may be overwritten at once. The next
// Wait fills the target of a Download.
class Stream {
  public:
    Stream() : handle_(backend::MakeStream()) {}
    ~Stream();
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;

    void Upload(void* device, const void* host, std::size_t bytes);
    void Download(void* host, const void* device, std::size_t bytes);
    void Copy(void* to, const void* from, std::size_t bytes) {
        backend::Copy(to, from, bytes, handle_);
    }  // on the device
    void Fill(void* device, unsigned char value, std::size_t bytes) {
        backend::Fill(device, value, bytes, handle_);
    }
    // Waits until all commands are done.
    void Wait();

    void* handle() const { return handle_; }

  private:
    struct Arrival {
        void* host;
        const std::byte* staged;
        std::size_t bytes;
    };
    std::byte* Stage(std::size_t bytes);

    void* handle_;
    std::byte* staging_ = nullptr;  // pinned
    std::size_t staging_bytes_ = 0, staged_ = 0;
    std::vector<Arrival> arrivals_;
};

// Counts allocations on the device against a limit. Must outlive its buffers.
class DeviceMemory {
  public:
    explicit DeviceMemory(std::size_t limit_bytes) : limit_bytes_(limit_bytes) {}
    DeviceMemory(const DeviceMemory&) = delete;
    DeviceMemory& operator=(const DeviceMemory&) = delete;

    bool HasRoom(std::size_t bytes) const {
        return bytes <= limit_bytes_ - std::min(used_bytes_, limit_bytes_);
    }
    // Returns null beyond the limit or if the device has no more.
    void* Allocate(std::size_t bytes);
    void Free(void* memory, std::size_t bytes);
    std::size_t used_bytes() const { return used_bytes_; }
    std::size_t limit_bytes() const { return limit_bytes_; }

  private:
    std::size_t limit_bytes_, used_bytes_ = 0;
};

// An array on the device that grows. T must be trivial.
template <class T>
class DeviceBuffer {
  public:
    static_assert(std::is_trivially_copyable_v<T>);

    explicit DeviceBuffer(DeviceMemory& memory) : memory_(memory) {}
    ~DeviceBuffer() { Free(); }
    DeviceBuffer(const DeviceBuffer&) = delete;
    DeviceBuffer& operator=(const DeviceBuffer&) = delete;

    // Makes room for at least `count` elements. Keeps the first `keep` of the old ones; the rest is
    // unspecified. Does nothing if there is room already. Returns false, with everything unchanged,
    // if the device has no room.
    [[nodiscard]] bool Reserve(Stream& stream, std::size_t count, std::size_t keep) {
        if (count <= capacity_) return true;
        auto* grown = static_cast<T*>(memory_.Allocate(count * sizeof(T)));
        if (grown == nullptr) return false;
        if (keep > 0) stream.Copy(grown, data_, std::min(keep, capacity_) * sizeof(T));
        if (data_ != nullptr) stream.Wait();  // commands under way may still use the old array
        Free();
        data_ = grown;
        capacity_ = count;
        return true;
    }
    // The same for temporary contents. Allocates half as much again, so that the buffer soon stops
    // growing.
    [[nodiscard]] bool ReserveScratch(Stream& stream, std::size_t count) {
        return count <= capacity_ || Reserve(stream, count + count / 2, 0) ||
               Reserve(stream, count, 0);
    }

    T* data() { return data_; }
    const T* data() const { return data_; }
    std::size_t capacity() const { return capacity_; }

  private:
    void Free() {
        if (data_ != nullptr) memory_.Free(data_, capacity_ * sizeof(T));
        data_ = nullptr;
        capacity_ = 0;
    }

    DeviceMemory& memory_;
    T* data_ = nullptr;
    std::size_t capacity_ = 0;
};

// Sorting, selection and prefix sums, with their temporary storage. False: no room on the device.
class DeviceSorter {
  public:
    explicit DeviceSorter(DeviceMemory& memory) : scratch_(memory) {}
    // Makes room to select among `count` items; SelectIndices then does not fail.
    [[nodiscard]] bool ReserveSelection(Stream& stream, int count);
    [[nodiscard]] bool SortKeys(Stream& stream, const std::uint64_t* keys, std::uint64_t* sorted,
                                int count);
    // Writes the indices i with keep[i] != 0 in increasing order, and how many there are.
    [[nodiscard]] bool SelectIndices(Stream& stream, const std::uint8_t* keep, int count,
                                     std::int32_t* indices, std::int32_t* selected);
    // sums[i] = counts[0] + ... + counts[i - 1], for i < count.
    [[nodiscard]] bool SumBefore(Stream& stream, const std::int32_t* counts, int count,
                                 std::int32_t* sums);

  private:
    DeviceBuffer<std::byte> scratch_;
};

}  // namespace tessera::TESSERA_DEVICE
