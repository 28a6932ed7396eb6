// Moves blocks of one map into another, some at a time.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "mapping/map_volume.h"
#include "optimize/warp_block.h"

namespace tessera {

// Of one block's kBlockVoxels: a voxel is nearer to a surface than the band is wide near the
// camera, or behind it. Other blocks hold free space only.
bool HasSurface(const FieldWord* field, const BlockMap::Config& map);

struct CoordHash {
    std::size_t operator()(const BlockCoord& c) const { return BlockHash(c); }
};

// Owner thread only; the map that is moved may be read by others. Uses TBB internally and gives the
// same result for any number of threads.
class BlockMover {
  public:
    using ShiftsAt = std::function<ShiftsAround(const BlockCoord&)>;

    // `map` outlives the object. `landings`: the blocks of the new map. `shifts`: around each of
    // them; thread-safe. `labels`: they move as well, and both maps have them.
    BlockMover(const BlockMap& map, std::vector<BlockCoord> landings, ShiftsAt shifts, bool labels);

    // Moves the next blocks, 1024 at most, which takes about 40 ms on one core. Replaces those that
    // `to` has, and adds none without surface. Of blocks that have changed there since revision
    // `newest` it only fills in the unknown voxels. Returns true once all are moved.
    bool Step(BlockMap& to, std::uint32_t newest = std::numeric_limits<std::uint32_t>::max());
    // Blocks of `to` so far: those that it did not have, in order of allocation, and all.
    const std::vector<BlockId>& added() const { return added_; }
    const std::vector<BlockId>& moved() const { return moved_; }

  private:
    void Warp(const std::vector<BlockCoord>& coords, std::vector<WarpedBlock>& blocks) const;
    void Put(BlockMap& to, std::uint32_t newest);

    const BlockMap& map_;
    std::vector<BlockCoord> landings_;
    ShiftsAt shifts_;
    bool labels_;
    std::size_t begun_ = 0;  // of the landings
    // Blocks that are warped, and those that are ready to be put into the new map.
    std::vector<BlockCoord> next_coords_, ready_coords_;
    std::vector<WarpedBlock> next_, ready_;
    std::vector<BlockId> added_, moved_;
};

// What becomes of these blocks of `map`, in this order, where everything moves by T_new_old, in the
// box. Without labels.
BlockMover MoveRigidly(const BlockMap& map, std::span<const BlockId> blocks,
                       const Eigen::Isometry3d& T_new_old, const WorldBox& box);

}  // namespace tessera
