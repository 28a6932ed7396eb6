#include "mapping/mesher.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "core/check.h"
#include "mapping/mesh_assembly.h"

namespace tessera {

bool CpuBlockMesher::MeshBlocks(const BlockMap& map, std::span<const BlockId> blocks,
                                double min_weight, BlockMeshes& meshes) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks.size(), 8), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
            meshes[static_cast<std::size_t>(blocks[i])] =
                map.IsFree(blocks[i]) ? nullptr : MeshBlock(map, blocks[i], min_weight);
    });
    return true;
}

int Mesher::Update(const BlockMap& map, int budget_blocks, BlockMesher& block_mesher) {
    voxel_size_m_ = map.config().voxel_size_m;
    FindChanged(map);
    std::size_t count =
        std::min(pending_.size(), static_cast<std::size_t>(std::max(budget_blocks, 0)));
    if (!block_mesher.MeshBlocks(map, {pending_.data(), count}, config_.min_weight, meshes_))
        count = 0;
    const auto done = pending_.begin() + static_cast<std::ptrdiff_t>(count);
    updated_.assign(pending_.begin(), done);
    pending_.erase(pending_.begin(), done);
    for (const BlockId id : updated_) is_pending_[static_cast<std::size_t>(id)] = 0;
    return remaining();
}

// Appends to pending_ every block that reads a block with a new revision, and every id that now
// belongs to another block or to none.
void Mesher::FindChanged(const BlockMap& map) {
    const std::size_t size = static_cast<std::size_t>(map.size());
    TESSERA_CHECK(size >= meshes_.size(), "the map shrank from {} to {} blocks without Clear",
                  meshes_.size(), size);
    meshes_.resize(size);
    seen_revision_.resize(size, 0);
    seen_number_.resize(size, 0);
    seen_coord_.resize(size);
    is_pending_.resize(size, 0);
    for (BlockId id = 1; id < map.size(); ++id) {
        const auto at = static_cast<std::size_t>(id);
        const std::uint32_t revision = map.revision(id);
        const bool same = seen_number_[at] == map.number(id);
        if (same && revision == seen_revision_[at]) continue;
        // Meshes that refer to the old block's vertices would find another block's.
        if (!same && seen_number_[at] != 0) {
            AddReaders(map, seen_coord_[at]);
            if (!std::exchange(is_pending_[at], std::uint8_t{1})) pending_.push_back(id);
        }
        seen_number_[at] = map.number(id);
        seen_coord_[at] = map.coord(id);
        seen_revision_[at] = revision;
        if (!map.IsFree(id)) AddReaders(map, map.coord(id));
    }
}

void Mesher::AddReaders(const BlockMap& map, const BlockCoord& block) {
    for (const auto& [dx, dy, dz] : kMeshReadOffsets) {
        const BlockId reader = map.Find({block.x - dx, block.y - dy, block.z - dz});
        if (reader == kUnknownBlock || is_pending_[static_cast<std::size_t>(reader)]) continue;
        is_pending_[static_cast<std::size_t>(reader)] = 1;
        pending_.push_back(reader);
    }
}

TriangleMesh Mesher::Assemble() const {
    return AssembleMesh(meshes_, voxel_size_m_, config_.min_component_triangles);
}

void Mesher::Clear() {
    meshes_.clear();
    seen_revision_.clear();
    seen_number_.clear();
    seen_coord_.clear();
    is_pending_.clear();
    pending_.clear();
    updated_.clear();
}

std::size_t Mesher::bytes() const {
    std::size_t total = meshes_.capacity() * (sizeof(meshes_[0]) + 2 * sizeof(std::uint32_t) +
                                              sizeof(BlockCoord) + 1) +
                        (pending_.capacity() + updated_.capacity()) * sizeof(BlockId);
    for (const auto& mesh : meshes_)
        if (mesh) total += mesh->bytes();
    return total;
}

}  // namespace tessera
