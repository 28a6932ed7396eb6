#include "mapping/virtual_array.h"

#include <sys/mman.h>

#include <new>

namespace tessera {

VirtualMemory::VirtualMemory(std::size_t bytes) : bytes_(bytes) {
    constexpr std::size_t kLeast = std::size_t{1} << 20;
    for (;;) {
        void* memory = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE,
                            MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (memory != MAP_FAILED) {
            data_ = static_cast<std::byte*>(memory);
            break;
        }
        if (bytes_ <= kLeast) throw std::bad_alloc();
        bytes_ /= 2;  // address space may be limited (ulimit -v); a smaller map is better than none
    }
    madvise(data_, bytes_, MADV_HUGEPAGE);  // otherwise gathers over many blocks miss the TLB
}

VirtualMemory::~VirtualMemory() { munmap(data_, bytes_); }

void VirtualMemory::Clear() { madvise(data_, bytes_, MADV_DONTNEED); }

}  // namespace tessera
