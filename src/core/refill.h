// Storage that is used again and again, such as a recycled message's.
#pragma once

#include <cstddef>
#include <vector>

namespace tessera {

// Resizes a vector whose elements need not be kept. Where it grows, old and new storage are not
// there at once, and the capacity is exact. Where less than a quarter of a large one is used, the
// storage is given back, so that one large message does not hold memory for ever.
template <class T>
void Refill(std::size_t count, std::vector<T>& values) {
    constexpr std::size_t kLarge = (std::size_t{1} << 20) / sizeof(T);
    const bool grows = count > values.capacity();
    const bool wastes = values.capacity() > kLarge && count < values.capacity() / 4;
    if (grows || wastes) {
        values = std::vector<T>();
        values.reserve(count);
    }
    values.resize(count);
}

}  // namespace tessera
