#include "optimize/map_warp.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <span>
#include <unordered_map>

#include "core/check.h"
#include "optimize/warp_block.h"

namespace tessera {
namespace {

struct CoordHash {
    std::size_t operator()(const BlockCoord& c) const { return BlockHash(c); }
};

// What lands in a block of the new map, in voxels of shift.
struct Landing {
    bool voxels = false;  // not only the shift of blocks beside it
    double weight = 0, square = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();

    void Add(double w, const Eigen::Vector3d& shift, double spread) {
        weight += w;
        sum += w * shift;
        square += w * (shift.squaredNorm() + spread * spread);
    }
    Eigen::Vector3d shift() const { return sum / weight; }
    double variance() const { return square / weight - shift().squaredNorm(); }
};

using Landings = std::unordered_map<BlockCoord, Landing, CoordHash>;

// Shares each block's motion among the up to eight blocks on which it lands.
Landings LandingsOf(const BlockMap& map, const std::vector<BlockMotion>& motions,
                    const WorldBox& box) {
    constexpr double kHalfVoxel = 0.5 / kBlockSide;  // less makes no voxel known
    const double voxel_m = map.config().voxel_size_m;
    Landings landings;
    landings.reserve(motions.size() * 2);
    for (BlockId id = 1; id < map.size(); ++id) {
        if (map.IsFree(id)) continue;
        const BlockMotion& motion = motions[static_cast<std::size_t>(id)];
        const Eigen::Vector3d shift = motion.shift_m.cast<double>() / voxel_m,
                              blocks = shift / kBlockSide, whole = blocks.array().floor(),
                              part = blocks - whole;
        const BlockCoord c = map.coord(id);
        for (int corner = 0; corner < 8; ++corner) {
            double weight = 1;
            bool voxels = true;
            for (int i = 0; i < 3; ++i) {
                const double share = corner >> i & 1 ? part[i] : 1 - part[i];
                weight *= share;
                voxels &= share >= kHalfVoxel;
            }
            if (weight < 1e-9) continue;
            const BlockCoord to{c.x + static_cast<int>(whole.x()) + (corner & 1),
                                c.y + static_cast<int>(whole.y()) + (corner >> 1 & 1),
                                c.z + static_cast<int>(whole.z()) + (corner >> 2)};
            if (!InLimits(to) || !Meets(box, to, kBlockSide * voxel_m)) continue;
            Landing& landing = landings[to];
            landing.Add(weight, shift, motion.spread_m / voxel_m);
            landing.voxels |= voxels;
        }
    }
    return landings;
}

// The shifts around a block that only moves. Where there is none, where surfaces change, and where
// another part of the map moves otherwise, the block's own stands in.
ShiftsAround ShiftsOf(const Landings& landings, const BlockCoord& c, double most_variance) {
    constexpr double kSamePart = kBlockSide / 2;  // voxels
    const Eigen::Vector3d own = landings.at(c).shift();
    ShiftsAround shifts;
    for (int i = 0; i < 27; ++i) {
        const auto found = landings.find({c.x + i % 3 - 1, c.y + i / 3 % 3 - 1, c.z + i / 9 - 1});
        const bool known = found != landings.end() && found->second.variance() <= most_variance &&
                           (found->second.shift() - own).cwiseAbs().maxCoeff() <= kSamePart;
        shifts[static_cast<std::size_t>(i)] = (known ? found->second.shift() : own).cast<float>();
    }
    return shifts;
}

// Warps blocks, some at a time, while those before are put into the new map.
class Mover {
  public:
    Mover(const BlockMap& map, const Landings& landings, double most_variance)
        : map_(map), landings_(landings), most_variance_(most_variance) {}

    void Move(std::span<const BlockCoord> moved, BlockMap& to) const {
        std::vector<WarpedBlock> next, ready;
        std::span<const BlockCoord> before;
        while (!moved.empty() || !before.empty()) {
            const auto now = moved.first(std::min(kAtOnce, moved.size()));
            tbb::parallel_invoke([&] { Warp(now, next); }, [&] { Put(before, ready, to); });
            moved = moved.subspan(now.size());
            before = now;
            std::swap(next, ready);
        }
    }

    std::vector<VoxelLabel> Labels(std::span<const BlockCoord> moved) const {
        std::vector<VoxelLabel> labels;
        std::vector<WarpedBlock> blocks;
        for (; !moved.empty(); moved = moved.subspan(blocks.size())) {
            Warp(moved.first(std::min(kAtOnce, moved.size())), blocks);
            for (const WarpedBlock& block : blocks)
                labels.insert(labels.end(), block.label.begin(), block.label.end());
        }
        return labels;
    }

  private:
    static constexpr std::size_t kAtOnce = 2048;

    void Warp(std::span<const BlockCoord> coords, std::vector<WarpedBlock>& blocks) const {
        blocks.resize(coords.size());
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, coords.size(), 64), [&](const auto& range) {
                BlockWarper warper(map_);
                for (std::size_t i = range.begin(); i < range.end(); ++i)
                    warper.Warp(coords[i], ShiftsOf(landings_, coords[i], most_variance_),
                                blocks[i]);
            });
    }
    static void Put(std::span<const BlockCoord> coords, const std::vector<WarpedBlock>& blocks,
                    BlockMap& to) {
        for (std::size_t i = 0; i < coords.size(); ++i) {
            if (!blocks[i].known) continue;
            const BlockId id = to.Allocate(coords[i]);
            if (id == kUnknownBlock) return;  // the map is full
            std::ranges::copy(blocks[i].field, to.field(id));
            std::ranges::copy(blocks[i].weight, to.weight(id));
            std::ranges::copy(blocks[i].colour, to.colour(id));
            if (to.has_labels()) std::ranges::copy(blocks[i].label, to.label(id));
        }
    }

    const BlockMap& map_;
    const Landings& landings_;
    const double most_variance_;
};

}  // namespace

WarpedMap WarpMap(const BlockMap& map, const std::vector<BlockMotion>& motions, const WorldBox& box,
                  double most_spread_m) {
    TESSERA_CHECK(map.layers() == BlockMap::Layers::kAll, "only a whole map can be moved");
    const double most_spread = most_spread_m / map.config().voxel_size_m,
                 most_variance = most_spread * most_spread;
    const Landings landings = LandingsOf(map, motions, box);
    WarpedMap warped{std::make_unique<BlockMap>(map.config()), {}, {}};
    if (map.has_labels()) warped.map->EnableLabels();
    std::vector<BlockCoord> moved;
    for (const auto& [c, landing] : landings)
        if (landing.voxels)
            (landing.variance() > most_variance ? warped.again : moved).push_back(c);
    std::ranges::sort(warped.again, std::less<>());
    std::ranges::sort(moved, std::less<>());
    const Mover mover(map, landings, most_variance);
    mover.Move(moved, *warped.map);
    if (map.has_labels()) warped.again_labels = mover.Labels(warped.again);
    return warped;
}

}  // namespace tessera
