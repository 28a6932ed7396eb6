// A small per-thread block cache for ray casting with the CPU's SIMD kernels.
#pragma once

#include <algorithm>

#include "mapping/block_kernels.h"

namespace tessera {

// Caches recently found blocks, including absent ones, in front of the map's much slower hash.
// Neighbouring rays mostly meet the same blocks.
template <class V>
class BlockCache {
  public:
    using Int = typename V::Int;
    using Mask = typename V::Mask;

    // Block coordinates must lie within this many blocks of the origin along each axis.
    static constexpr std::int32_t kReachBlocks = 4096;

    BlockCache() { std::fill_n(keys_, kSlots, kEmpty); }

    // Block ids of the wanted lanes; the other lanes get arbitrary ids of the map. `block` is
    // relative to map.origin_block, which must be the same in every call.
    template <class Map>
    TESSERA_HD_MEMBER Int Find(const Map& map, const Int* block, const Mask& wanted) {
        Int slot(0), key(0);
        for (int k = 0; k < 3; ++k) {
            slot = slot | (block[k] & Int((1 << kSlotBits) - 1)) << (kSlotBits * k);
            key = key | ((block[k] >> kSlotBits) & Int((1 << kKeyBits) - 1)) << (kKeyBits * k);
        }
        const Int id = V::Gather(ids_, slot);
        const Mask missing = wanted && V::ToMask(V::Gather(keys_, slot) != key);
        return V::Any(missing) ? V::Select(missing, Add(map, block, slot, key, missing), id) : id;
    }

  private:
    static constexpr int kSlotBits = 3, kKeyBits = 10;  // per axis
    static constexpr int kSlots = 1 << (3 * kSlotBits);
    static constexpr std::int32_t kEmpty = -1;
    static_assert(2 * kReachBlocks == 1 << (kSlotBits + kKeyBits), "two blocks would share a key");

    template <class Map>
    [[gnu::noinline]] Int Add(const Map& map, const Int* block, const Int& slot, const Int& key,
                              const Mask& missing) {
        const Int found = HashedBlocks<V>().Find(map, block, missing);
        alignas(64) std::uint32_t slots[V::kCount], keys[V::kCount], ids[V::kCount],
            wanted[V::kCount];
        V::Store(V::AsBits(slot), slots);
        V::Store(V::AsBits(key), keys);
        V::Store(V::AsBits(found), ids);
        V::Store(V::AsBits(V::Select(missing, Int(1), Int(0))), wanted);
        for (int i = 0; i < V::kCount; ++i) {
            if (!wanted[i]) continue;
            keys_[slots[i]] = static_cast<std::int32_t>(keys[i]);
            ids_[slots[i]] = static_cast<std::int32_t>(ids[i]);
        }
        return found;
    }

    alignas(64) std::int32_t keys_[kSlots], ids_[kSlots] = {};
};

}  // namespace tessera
