#include "render/geometry_builder.h"

#include <tbb/parallel_for.h>

namespace tessera {

std::span<GeometryBlock> GeometryBuilder::Build(const BlockMap& map, const Mesher& mesher,
                                                const MarkVertex& mark) {
    FindStale(map, mesher);
    if (blocks_.size() < stale_.size()) blocks_.resize(stale_.size());
    const auto& meshes = mesher.block_meshes();
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, stale_.size(), 16), [&](const auto& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                GeometryBlock& block = blocks_[i];
                block.id = stale_[i];
                block.coord = map.coord(stale_[i]);
                if (const BlockMesh* mesh = meshes[static_cast<std::size_t>(stale_[i])].get()) {
                    block.geometry.Build(*mesh, meshes, mark);
                } else {
                    block.geometry.vertices.clear();
                    block.geometry.indices.clear();
                }
            }
        });
    return {blocks_.data(), stale_.size()};
}

void GeometryBuilder::FindStale(const BlockMap& map, const Mesher& mesher) {
    is_stale_.resize(mesher.block_meshes().size(), 0);
    stale_.clear();
    const auto add = [&](BlockId id) {
        if (id == kUnknownBlock || is_stale_[static_cast<std::size_t>(id)]) return;
        is_stale_[static_cast<std::size_t>(id)] = 1;
        stale_.push_back(id);
    };
    const auto has_mesh = [&](BlockId id) {
        return mesher.block_meshes()[static_cast<std::size_t>(id)] != nullptr;
    };
    const auto add_borrowers = [&](BlockId id) {
        for (int slot = 1; slot < 8; ++slot)
            if (const BlockId lower =
                    map.neighbour(id, -(slot & 1), -(slot >> 1 & 1), -(slot >> 2));
                has_mesh(lower))
                add(lower);
    };
    for (const BlockId id : mesher.updated()) {
        add(id);
        add_borrowers(id);
    }
    // A vertex belongs to the block of the lower of its two voxels.
    for (const BlockId id : remarked_)
        for (const BlockId owner : {id, map.neighbour(id, -1, 0, 0), map.neighbour(id, 0, -1, 0),
                                    map.neighbour(id, 0, 0, -1)})
            if (has_mesh(owner)) {
                add(owner);
                add_borrowers(owner);
            }
    remarked_.clear();
    for (const BlockId id : stale_) is_stale_[static_cast<std::size_t>(id)] = 0;
}

}  // namespace tessera
