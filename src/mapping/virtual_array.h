// An array that grows without moving: it reserves address space once, and the system commits pages
// as they are touched. Readers can keep plain pointers, SIMD gathers have one base, and growth
// copies nothing.
#pragma once

#include <cstddef>

namespace tessera {

// Raw reservation; VirtualArray below adds the element type. Not copyable.
class VirtualMemory {
  public:
    // Reserves `bytes` of address space (no memory yet). Halves the request until the system grants
    // it; throws std::bad_alloc if it does not grant a megabyte.
    explicit VirtualMemory(std::size_t bytes);
    ~VirtualMemory();
    VirtualMemory(const VirtualMemory&) = delete;
    VirtualMemory& operator=(const VirtualMemory&) = delete;

    std::byte* data() const { return data_; }
    std::size_t reserved_bytes() const { return bytes_; }
    // Returns all pages to the system; they read as zero again.
    void Clear();

  private:
    std::byte* data_ = nullptr;
    std::size_t bytes_ = 0;
};

// Elements read as all-zero bytes until written. T must be trivial.
template <class T>
class VirtualArray {
  public:
    explicit VirtualArray(std::size_t max_elements) : memory_(max_elements * sizeof(T)) {}

    std::size_t max_size() const { return memory_.reserved_bytes() / sizeof(T); }
    T* data() { return reinterpret_cast<T*>(memory_.data()); }
    const T* data() const { return reinterpret_cast<const T*>(memory_.data()); }
    T& operator[](std::size_t i) { return data()[i]; }
    const T& operator[](std::size_t i) const { return data()[i]; }
    void Clear() { memory_.Clear(); }

  private:
    VirtualMemory memory_;
};

}  // namespace tessera
