#include "render/range_pool.h"

#include <bit>
#include <limits>

#include "core/check.h"

namespace tessera {

std::uint32_t RangePool::ClassSize(std::uint32_t count) {
    constexpr std::uint32_t kSmallest = 16;
    if (count == 0) return 0;
    if (count <= kSmallest) return kSmallest;
    const std::uint32_t step = std::bit_floor(count - 1) / 4;
    return (count + step - 1) / step * step;
}

RangePool::Range RangePool::Allocate(std::uint32_t count) {
    const std::uint32_t size = ClassSize(count);
    if (size == 0) return {};
    used_ += size;
    std::vector<std::uint32_t>& free = free_[size];
    if (!free.empty()) {
        const std::uint32_t first = free.back();
        free.pop_back();
        return {first, size};
    }
    TESSERA_CHECK(end_ <= std::numeric_limits<std::int32_t>::max() - size, "{} items and {} more",
                  end_, size);
    const Range range{end_, size};
    end_ += size;
    return range;
}

void RangePool::Free(Range& range) {
    if (range.size != 0) free_[range.size].push_back(range.first);
    used_ -= range.size;
    range = {};
}

}  // namespace tessera
