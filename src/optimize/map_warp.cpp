#include "optimize/map_warp.h"

#include <algorithm>
#include <limits>
#include <unordered_map>

#include "core/check.h"

namespace tessera {
namespace {

// Shifts of two blocks, in voxels, that belong to one part of the map.
bool OfOnePart(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (a - b).cwiseAbs().maxCoeff() <= kBlockSide / 2;
}

// What lands in a block of the new map, in voxels of shift.
struct Landing {
    bool voxels = false;  // with surface; else only the shift of blocks beside it
    double weight = 0, square = 0, first_weight = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), first = sum, first_sum = sum;

    void Add(double w, const Eigen::Vector3d& shift, double spread) {
        if (weight == 0) first = shift;
        weight += w;
        sum += w * shift;
        square += w * (shift.squaredNorm() + spread * spread);
        if (!OfOnePart(shift, first)) return;
        first_weight += w;
        first_sum += w * shift;
    }
    // Of the part that came first.
    Eigen::Vector3d shift() const { return first_sum / first_weight; }
    double variance() const { return square / weight - (sum / weight).squaredNorm(); }
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
        const bool surface = HasSurface(map.field(id), map.config());
        const BlockMotion& motion = motions[static_cast<std::size_t>(id)];
        const Eigen::Vector3d shift = motion.shift_m.cast<double>() / voxel_m,
                              blocks = shift / kBlockSide, whole = blocks.array().floor(),
                              part = blocks - whole;
        const BlockCoord c = map.coord(id);
        for (int corner = 0; corner < 8; ++corner) {
            double weight = 1;
            bool voxels = surface;
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

// The shifts around a block that moves. Where there is none, where they are doubtful, and where
// another part of the map moves otherwise, the block's own stands in.
ShiftsAround ShiftsOf(const Landings& landings, const BlockCoord& c, double most_variance) {
    const Eigen::Vector3d own = landings.at(c).shift();
    ShiftsAround shifts;
    for (int i = 0; i < 27; ++i) {
        const auto found = landings.find({c.x + i % 3 - 1, c.y + i / 3 % 3 - 1, c.z + i / 9 - 1});
        const bool known = found != landings.end() && found->second.variance() <= most_variance &&
                           OfOnePart(found->second.shift(), own);
        shifts[static_cast<std::size_t>(i)] = (known ? found->second.shift() : own).cast<float>();
    }
    return shifts;
}

}  // namespace

MapWarp::MapWarp(const BlockMap& map, const std::vector<BlockMotion>& motions, const WorldBox& box,
                 double most_spread_m, Doubtful doubtful) {
    TESSERA_CHECK(map.layers() == BlockMap::Layers::kAll, "only a whole map can be moved");
    const double most_spread = most_spread_m / map.config().voxel_size_m,
                 most_variance = most_spread * most_spread;
    Landings landings = LandingsOf(map, motions, box);
    warped_.map = std::make_unique<BlockMap>(map.config());
    warped_.whole = doubtful == Doubtful::kMoved;
    std::vector<BlockCoord> moved;
    for (const auto& [c, landing] : landings) {
        if (!landing.voxels) continue;
        const bool agreed = landing.variance() <= most_variance;
        if (!agreed) warped_.doubtful.push_back(c);
        if (agreed || warped_.whole) moved.push_back(c);
    }
    std::ranges::sort(warped_.doubtful, std::less<>());
    std::ranges::sort(moved, std::less<>());
    const auto shared = std::make_shared<const Landings>(std::move(landings));
    const auto move = [&](std::vector<BlockCoord> coords, double most) {
        return std::make_unique<BlockMover>(
            map, std::move(coords),
            [shared, most](const BlockCoord& c) { return ShiftsOf(*shared, c, most); },
            map.has_labels());
    };
    constexpr double kAny = std::numeric_limits<double>::infinity();
    mover_ = move(std::move(moved), warped_.whole ? kAny : most_variance);
    if (map.has_labels()) warped_.map->EnableLabels();
    if (warped_.whole) return;
    rough_mover_ = move(warped_.doubtful, kAny);
    warped_.rough = std::make_unique<BlockMap>(map.config());
    if (map.has_labels()) warped_.rough->EnableLabels();
}

bool MapWarp::Step() {
    return mover_->Step(*warped_.map) && (!rough_mover_ || rough_mover_->Step(*warped_.rough));
}

}  // namespace tessera
