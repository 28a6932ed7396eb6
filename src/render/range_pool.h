// Shares one growing buffer out in ranges: sizes are rounded up to a few classes, each with a list
// of the ranges that were given back, so that meshing a block again and again uses the same memory
// again and again. Counts only; the buffer is its owner's.
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
        std::uint32_t size = 0;  // at least what was asked for; 0: no range
    };

    // A range of at least `count` items, the empty one for 0. May reach past the buffer's old end:
    // see end().
    Range Allocate(std::uint32_t count);
    // Gives a range back and leaves it empty.
    void Free(Range& range);
    // Whether `count` items are just what the range would be allocated for.
    static bool Fits(const Range& range, std::uint32_t count) {
        return range.size == ClassSize(count);
    }

    std::uint32_t end() const { return end_; }    // items that the buffer must have
    std::uint32_t used() const { return used_; }  // items in ranges that were not given back

  private:
    // Four classes per power of two, so that at most a fifth is unused.
    static std::uint32_t ClassSize(std::uint32_t count);

    std::uint32_t end_ = 0, used_ = 0;
    std::map<std::uint32_t, std::vector<std::uint32_t>> free_;  // first items by size
};

}  // namespace tessera
