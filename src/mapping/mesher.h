// The map's surface as a triangle mesh, kept up to date block by block: only what changed is meshed
// again. Owns the block meshes, copies what it needs from the map, and needs the map only inside
// Update.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/mesh.h"
#include "mapping/block_mesher.h"

namespace tessera {

// Owner thread only; Update works on all of TBB's threads and gives the same bytes for any number
// of them.
class Mesher {
  public:
    using Config = MeshConfig;
    static constexpr int kNoLimit = std::numeric_limits<int>::max();

    explicit Mesher(const Config& config) : config_(config) {}

    // Meshes again the blocks whose result may have changed since the last call: those that read a
    // block (kMeshReadOffsets) whose BlockMap::revision differs from the one last seen. So whoever
    // writes the map must use a new revision after each Update. At most `budget_blocks` are done,
    // oldest first; returns how many remain. Nobody may write the map meanwhile. Blocks may come
    // and go between calls; Clear when it is another map. With `device` that one meshes, in a map
    // whose blocks do not go; where it has no room none is done.
    int Update(const BlockMap& map, int budget_blocks = kNoLimit, BlockMesher* device = nullptr);

    // The whole mesh, with normals and colours. Vertices are shared across blocks, ordered by block
    // id and edge; only those that a triangle uses. While blocks remain to be done there may be
    // gaps between old and new blocks.
    TriangleMesh Assemble() const;

    // Forgets everything; to be called when the map was cleared or replaced.
    void Clear();

    // What the last Update meshed, oldest first, for those who keep copies of the block meshes.
    std::span<const BlockId> updated() const { return updated_; }
    const BlockMeshes& block_meshes() const { return meshes_; }

    const Config& config() const { return config_; }
    int remaining() const { return static_cast<int>(pending_.size()); }
    std::size_t bytes() const;  // memory of all block meshes

  private:
    void MeshHere(const BlockMap& map, std::span<const BlockId> blocks);
    void FindChanged(const BlockMap& map);
    void AddReaders(const BlockMap& map, const BlockCoord& block);

    Config config_;
    double voxel_size_m_ = 0;
    // By block id.
    BlockMeshes meshes_;
    std::vector<std::uint32_t> seen_revision_;
    // BlockMap::number: an id may be another block's by now.
    std::vector<std::int32_t> seen_number_;
    std::vector<BlockCoord> seen_coord_;
    std::vector<std::uint8_t> is_pending_;
    std::vector<BlockId> pending_;  // to be meshed, oldest first
    std::vector<BlockId> updated_;  // by the last Update
};

}  // namespace tessera
