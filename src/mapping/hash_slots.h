// Erasure for hash tables like the map's: power-of-two size, linear probing, 0 = empty.
#pragma once

#include <cstdint>
#include <vector>

namespace tessera {

// Empties a slot. Moves up later entries that the gap would hide. `hash_of` returns an entry's
// hash.
template <class HashOf>
void EraseSlot(std::vector<std::int32_t>& table, std::uint32_t gap, const HashOf& hash_of) {
    const std::uint32_t mask = static_cast<std::uint32_t>(table.size() - 1);
    for (std::uint32_t slot = (gap + 1) & mask; table[slot] != 0; slot = (slot + 1) & mask) {
        const std::uint32_t home = hash_of(table[slot]) & mask;
        if (((slot - home) & mask) < ((slot - gap) & mask)) continue;
        table[gap] = table[slot];
        gap = slot;
    }
    table[gap] = 0;
}

}  // namespace tessera
