#include "optimize/block_mover.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <unordered_set>
#include <utility>

namespace tessera {
namespace {

constexpr std::size_t kAtOnce = 1024;

// In voxels.
Eigen::Vector3d Corner(const BlockCoord& c) { return kBlockSide * Eigen::Vector3d(c.x, c.y, c.z); }

Eigen::AlignedBox3d BoxOf(const BlockCoord& c) {
    return {Corner(c), Corner(c) + Eigen::Vector3d::Constant(kBlockSide - 1)};
}

// `T_new_old` in voxels.
std::vector<BlockCoord> LandingsOfAll(const BlockMap& map, std::span<const BlockId> blocks,
                                      const Eigen::Isometry3d& T_new_old, const WorldBox& box) {
    const double block_m = kBlockSide * map.config().voxel_size_m;
    std::vector<BlockCoord> landings;
    std::unordered_set<BlockCoord, CoordHash> known;
    for (const BlockId id : blocks) {
        const Eigen::AlignedBox3d to = BoxOf(map.coord(id)).transformed(T_new_old);
        const Eigen::Vector3i first = ((to.min().array() - 0.5) / kBlockSide).floor().cast<int>();
        const Eigen::Vector3i last = ((to.max().array() + 0.5) / kBlockSide).floor().cast<int>();
        for (int z = first.z(); z <= last.z(); ++z)
            for (int y = first.y(); y <= last.y(); ++y)
                for (int x = first.x(); x <= last.x(); ++x)
                    if (const BlockCoord c{x, y, z};
                        InLimits(c) && Meets(box, c, block_m) && known.insert(c).second)
                        landings.push_back(c);
    }
    return landings;
}

}  // namespace

bool HasSurface(const FieldWord* field, const BlockMap::Config& map) {
    const auto near = static_cast<float>(map.truncation_m / map.range_m());
    return std::any_of(field, field + kBlockVoxels, [&](FieldWord word) {
        return HasDistance(word) && FieldDistance(word) < near;
    });
}

BlockMover::BlockMover(const BlockMap& map, std::vector<BlockCoord> landings, ShiftsAt shifts,
                       bool labels)
    : map_(map), landings_(std::move(landings)), shifts_(std::move(shifts)), labels_(labels) {}

// Blocks are warped while those before are put into the new map.
bool BlockMover::Step(BlockMap& to, std::uint32_t newest) {
    const std::size_t count = std::min(kAtOnce, landings_.size() - begun_);
    const auto first = landings_.begin() + static_cast<std::ptrdiff_t>(begun_);
    next_coords_.assign(first, first + static_cast<std::ptrdiff_t>(count));
    begun_ += count;
    tbb::parallel_invoke([&] { Warp(next_coords_, next_); }, [&] { Put(to, newest); });
    std::swap(next_, ready_);
    std::swap(next_coords_, ready_coords_);
    return ready_coords_.empty();
}

void BlockMover::Warp(const std::vector<BlockCoord>& coords,
                      std::vector<WarpedBlock>& blocks) const {
    blocks.resize(coords.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, coords.size(), 64),
                      [&](const auto& range) {
                          BlockWarper warper(map_);
                          for (std::size_t i = range.begin(); i < range.end(); ++i)
                              warper.Warp(coords[i], shifts_(coords[i]), blocks[i]);
                      });
}

void BlockMover::Put(BlockMap& to, std::uint32_t newest) {
    for (std::size_t i = 0; i < ready_coords_.size(); ++i) {
        const WarpedBlock& block = ready_[i];
        if (!block.known) continue;
        const BlockId before = to.Find(ready_coords_[i]);
        const bool is_new = before == kUnknownBlock, keep = to.revision(before) > newest;
        if (is_new && !HasSurface(block.field.data(), to.config())) continue;
        const BlockId id = to.Allocate(ready_coords_[i]);
        if (id == kUnknownBlock) return;  // the map is full
        if (is_new) added_.push_back(id);
        moved_.push_back(id);
        for (std::size_t v = 0; v < kBlockVoxels; ++v) {
            if (keep && HasDistance(to.field(id)[v])) continue;
            to.field(id)[v] = block.field[v];
            to.weight(id)[v] = block.weight[v];
            to.colour(id)[v] = block.colour[v];
            if (labels_) to.label(id)[v] = block.label[v];
        }
    }
}

BlockMover MoveRigidly(const BlockMap& map, std::span<const BlockId> blocks,
                       const Eigen::Isometry3d& T_new_old, const WorldBox& box) {
    Eigen::Isometry3d T = T_new_old;
    T.translation() /= map.config().voxel_size_m;
    const Eigen::Isometry3d T_inverse = T.inverse();
    const auto shifts_at = [T_inverse](const BlockCoord& c) {
        ShiftsAround shifts;
        for (int i = 0; i < 27; ++i) {
            const BlockCoord at{c.x + i % 3 - 1, c.y + i / 3 % 3 - 1, c.z + i / 9 - 1};
            const Eigen::Vector3d centre = BoxOf(at).center();
            shifts[static_cast<std::size_t>(i)] = (centre - T_inverse * centre).cast<float>();
        }
        return shifts;
    };
    return {map, LandingsOfAll(map, blocks, T, box), shifts_at, false};
}

}  // namespace tessera
