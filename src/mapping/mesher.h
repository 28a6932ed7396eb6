// The map's surface as a triangle mesh, updated block by block: only changed blocks are meshed
// again. Owns the block meshes and reads the map only inside Update.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/mesh.h"
#include "mapping/block_mesher.h"

namespace tessera {

// Owner thread only. Update runs on all TBB threads and gives the same bytes for any number of
// them.
class Mesher {
  public:
    using Config = MeshConfig;
    static constexpr int kNoLimit = std::numeric_limits<int>::max();

    explicit Mesher(const Config& config) : config_(config) {}

    // Remeshes the blocks whose result may have changed since the last call: those that read a
    // block (kMeshReadOffsets) whose BlockMap::revision differs from the last one seen. So the
    // writer of the map must use a new revision after each Update. Meshes at most `budget_blocks`,
    // oldest first, and returns how many remain. Nobody may write the map meanwhile. Blocks may be
    // allocated and released between calls; call Clear for another map. If a device's block mesher
    // has no room, no block is done.
    int Update(const BlockMap& map, int budget_blocks, BlockMesher& block_mesher);
    int Update(const BlockMap& map, int budget_blocks = kNoLimit) {
        CpuBlockMesher on_cpu;
        return Update(map, budget_blocks, on_cpu);
    }

    // The whole mesh, with normals and colours. Blocks share vertices, which are ordered by block
    // id and edge; unused vertices are left out. While blocks remain to be done, there may be gaps
    // between old and new blocks.
    TriangleMesh Assemble() const;

    // Forgets everything. Call this when the map is cleared or replaced.
    void Clear();

    // The blocks that the last Update meshed, oldest first, for holders of block mesh copies.
    std::span<const BlockId> updated() const { return updated_; }
    const BlockMeshes& block_meshes() const { return meshes_; }

    const Config& config() const { return config_; }
    int remaining() const { return static_cast<int>(pending_.size()); }
    std::size_t bytes() const;  // memory of all block meshes

  private:
    void FindChanged(const BlockMap& map);
    void AddReaders(const BlockMap& map, const BlockCoord& block);

    Config config_;
    double voxel_size_m_ = 0;
    // Indexed by block id.
    BlockMeshes meshes_;
    std::vector<std::uint32_t> seen_revision_;
    // BlockMap::number, because an id may belong to another block by now.
    std::vector<std::int32_t> seen_number_;
    std::vector<BlockCoord> seen_coord_;
    std::vector<std::uint8_t> is_pending_;
    std::vector<BlockId> pending_;  // to be meshed, oldest first
    std::vector<BlockId> updated_;  // by the last Update
};

}  // namespace tessera
