// Copies a map for another thread while its owner goes on fusing into it.
#pragma once

#include <memory>

#include "mapping/block_map.h"

namespace tessera {

// For the map's owner thread. No block may be released meanwhile.
class MapCopier {
  public:
    // Copies at most this many blocks, and once none is left, at once those that have changed since
    // they were copied. Then returns the copy, which is the map as it is now, without labels and
    // with ids of its own; else null. Begins again with another map, or if it was cleared.
    // `revision`: as of the latest change.
    std::unique_ptr<BlockMap> Copy(const BlockMap& map, std::uint32_t revision, int blocks);
    bool begun() const { return copy_ != nullptr; }
    void Stop() { copy_.reset(); }
    // The map's revision when the last copy was whole, even if another was begun since. 0: there
    // was none of this map.
    std::uint32_t copied(const BlockMap& map) const {
        return map.identity() == identity_ ? copied_ : 0;
    }

  private:
    std::unique_ptr<BlockMap> copy_;  // null: not begun
    BlockId next_ = 1;
    std::uint64_t identity_ = 0;            // of the map that is copied
    std::uint32_t begun_ = 0, copied_ = 0;  // revisions
};

// Blocks of a map that have changed since this revision.
std::vector<BlockId> ChangedSince(const BlockMap& map, std::uint32_t revision);

}  // namespace tessera
