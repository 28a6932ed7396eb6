// Hash tables as the map's are: a power of two of slots, linear probing, 0 = empty.
#pragma once

#include <cstdint>
#include <vector>

namespace tessera {

// Empties a slot; entries behind it move up where the gap would hide them. `hash_of` gives an
// entry's hash.
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
