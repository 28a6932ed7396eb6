#include "mapping/map_copier.h"

#include "mapping/map_delta.h"

namespace tessera {

std::vector<BlockId> ChangedSince(const BlockMap& map, std::uint32_t revision) {
    std::vector<BlockId> changed;
    for (BlockId id = 1; id < map.size(); ++id)
        if (map.revision(id) > revision && !map.IsFree(id)) changed.push_back(id);
    return changed;
}

std::unique_ptr<BlockMap> MapCopier::Copy(const BlockMap& map, std::uint32_t revision, int blocks) {
    if (!copy_ || map.identity() != identity_) {
        copy_ = std::make_unique<BlockMap>(map.config());
        copied_ = copied(map);
        identity_ = map.identity();
        next_ = 1;
        begun_ = revision;
    }
    const auto copy = [&](BlockId id) {
        CopyVoxels(map, id, *copy_, copy_->Allocate(map.coord(id)));
    };
    for (; next_ < map.size() && blocks > 0; ++next_, --blocks)
        if (!map.IsFree(next_)) copy(next_);
    if (next_ < map.size()) return nullptr;
    for (const BlockId id : ChangedSince(map, begun_)) copy(id);
    copied_ = revision;
    return std::move(copy_);
}

}  // namespace tessera
