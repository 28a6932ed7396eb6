// Divides one growing buffer into ranges. Sizes are rounded up to a few classes, each with a list
// of free ranges, so that repeated meshing of a block reuses the same memory. Does only the
// bookkeeping; the caller owns the buffer.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

namespace tessera {

// Owner thread only.
class RangePool {
  public:
    struct Range {
        std::uint32_t first = 0;
        std::uint32_t size = 0;  // at least the requested size; 0 = no range
    };

    // Returns a range of at least `count` items; an empty one for 0. It may extend past the
    // buffer's old end (see end()).
    Range Allocate(std::uint32_t count);
    // Returns a range to the pool and empties it.
    void Free(Range& range);
    // Whether Allocate(count) would return a range of this size.
    static bool Fits(const Range& range, std::uint32_t count) {
        return range.size == ClassSize(count);
    }

    std::uint32_t end() const { return end_; }    // items that the buffer must hold
    std::uint32_t used() const { return used_; }  // items in allocated ranges

  private:
    // Four classes per power of two, so that at most a fifth is unused.
    static std::uint32_t ClassSize(std::uint32_t count);

    std::uint32_t end_ = 0, used_ = 0;
    // first items of free ranges, by size
    std::map<std::uint32_t, std::vector<std::uint32_t>> free_;
};

}  // namespace tessera
