#include "semantics/label_votes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace tessera {
namespace {

// Weight of a vote against an instance that is itself detected in this frame: the two are distinct.
constexpr int kApartWeight = 3;

struct Voting {
    const LabelImage& labels;
    std::span<const Ballot> ballots;
    std::span<const Holder> holders;
    const DepthImage& depth_m;
    const PinholeCamera& camera;
    Eigen::Isometry3d T_camera_world;
    double band_m;

    Holder HolderOf(const VoxelLabel& voxel) const {
        return voxel.instance < holders.size() ? holders[voxel.instance] : Holder{};
    }
    bool IsDetected(std::uint16_t instance) const {
        return std::ranges::any_of(
            ballots, [&](const Ballot& ballot) { return ballot.instance == instance; });
    }
};

struct Claims {
    std::uint8_t first = 0, second = 0;
};

// One pixel's vote for one voxel.
struct Vote {
    std::uint8_t class_id = 0;
    std::uint16_t instance = 0;
    int weight = 0;  // of the vote for the instance
};

Vote VoteOf(const Voting& v, const Claims& claims, const Holder& held_by) {
    const std::uint16_t holder = held_by.instance;
    if (claims.first == LabelImage::kBesideObjects)
        return held_by.stands && !v.IsDetected(holder) ? Vote{} : Vote{kBackgroundClass, 0, 1};
    const Ballot* ballot = &v.ballots[claims.first - 1u];
    if (holder == 0 || holder == ballot->instance || ballot->instance == 0)
        return {ballot->class_id, ballot->instance, 1};
    if (claims.second != 0 && ballot->shown && v.ballots[claims.second - 1u].instance == holder)
        return {v.ballots[claims.second - 1u].class_id, holder, 1};
    if (std::ranges::find(ballot->covered, holder) != ballot->covered.end()) return {};
    return {ballot->class_id, ballot->instance, v.IsDetected(holder) ? kApartWeight : 1};
}

// Returns the map's blocks around the surface of the labelled pixels, without duplicates, in
// increasing order.
std::vector<BlockId> BlocksOf(const Voting& v, const Eigen::Isometry3d& T_world_camera,
                              const BlockMap& map) {
    const double block_m = map.config().voxel_size_m * kBlockSide, margin = v.band_m / block_m;
    constexpr int kStep = 2;
    constexpr int kRows = 16;
    const int bands = (v.depth_m.height() + kRows - 1) / kRows;
    std::vector<std::vector<BlockId>> found(static_cast<std::size_t>(bands));
    tbb::parallel_for(0, bands, [&](int band) {
        std::vector<BlockId>& blocks = found[static_cast<std::size_t>(band)];
        for (int y = band * kRows; y < std::min(v.depth_m.height(), (band + 1) * kRows); y += kStep)
            for (int x = 0; x < v.depth_m.width(); x += kStep) {
                if (v.labels.detection(x, y) == 0 || v.depth_m(x, y) <= 0) continue;
                const Eigen::Vector3d p =
                    T_world_camera * v.camera.Unproject(x, y, v.depth_m(x, y)) / block_m;
                const Eigen::Array3i low = (p.array() - margin).floor().cast<int>();
                const Eigen::Array3i high = (p.array() + margin).floor().cast<int>();
                for (int bz = low.z(); bz <= high.z(); ++bz)
                    for (int by = low.y(); by <= high.y(); ++by)
                        for (int bx = low.x(); bx <= high.x(); ++bx) {
                            const BlockId id = map.Find({bx, by, bz});
                            if (id != kUnknownBlock && (blocks.empty() || blocks.back() != id))
                                blocks.push_back(id);
                        }
            }
        std::ranges::sort(blocks);
        blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
    });
    std::vector<BlockId> all;
    for (const auto& blocks : found) all.insert(all.end(), blocks.begin(), blocks.end());
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

// Returns the claims of the pixel that sees the point; empty if no pixel does.
Claims ClaimsAt(const Voting& v, const Eigen::Vector3d& p_camera, const TruncationBand& band) {
    if (p_camera.z() < 0.01) return {};
    const Eigen::Vector2d pixel = v.camera.Project(p_camera);
    if (!(std::abs(pixel.x()) < 1e6) || !(std::abs(pixel.y()) < 1e6)) return {};
    const int x = static_cast<int>(std::lround(pixel.x())),
              y = static_cast<int>(std::lround(pixel.y()));
    if (!v.depth_m.Contains(x, y)) return {};
    const float z = v.depth_m(x, y);
    if (z <= 0 || std::abs(z - p_camera.z()) > band.At(z)) return {};
    return {v.labels.detection(x, y), v.labels.second(x, y)};
}

bool IsSettledOnObject(const VoxelLabel& voxel) {
    return voxel.settled != 0 && voxel.settled != kBackgroundClass;
}

VoteCount VoteInBlock(const Voting& v, BlockId id, BlockMap& map) {
    VoteCount count;
    const BlockCoord c = map.coord(id);
    const double voxel_m = map.config().voxel_size_m;
    const TruncationBand band = map.config().band();
    const float farthest = static_cast<float>(v.band_m) / band.most_m;
    const FieldWord* field = map.field(id);
    for (int i = 0; i < kBlockVoxels; ++i) {
        if (!HasDistance(field[i]) || std::abs(FieldDistance(field[i])) > farthest) continue;
        const Eigen::Vector3d voxel(8.0 * c.x + (i & 7), 8.0 * c.y + (i >> 3 & 7),
                                    8.0 * c.z + (i >> 6));
        const Claims claims = ClaimsAt(v, v.T_camera_world * (voxel * voxel_m), band);
        if (claims.first == 0) continue;
        VoxelLabel& voxel_label = map.label(id)[i];
        const Holder holder = v.HolderOf(voxel_label);
        const Vote vote = VoteOf(v, claims, holder);
        if (vote.class_id == 0) continue;
        HoldInstance(holder.instance, voxel_label);
        const bool was_settled = IsSettledOnObject(voxel_label);
        count.flips += VoteForClass(vote.class_id, voxel_label);
        count.settled += !was_settled && IsSettledOnObject(voxel_label);
        for (int k = 0; k < vote.weight; ++k) VoteForInstance(vote.instance, voxel_label);
        ++count.voxels;
    }
    return count;
}

}  // namespace

VoteCount VoteLabels(const LabelImage& labels, std::span<const Ballot> ballots,
                     std::span<const Holder> holders, const DepthImage& depth_m,
                     const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
                     double band_m, BlockMap& map) {
    const Voting voting{labels, ballots, holders, depth_m, camera, T_world_camera.inverse(),
                        band_m};
    const std::vector<BlockId> blocks = BlocksOf(voting, T_world_camera, map);
    std::vector<std::uint8_t> got_votes(blocks.size());
    std::atomic<std::int64_t> voxels = 0, flips = 0, settled = 0;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks.size(), 16),
                      [&](const auto& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i) {
                              const VoteCount count = VoteInBlock(voting, blocks[i], map);
                              voxels += count.voxels;
                              flips += count.flips;
                              settled += count.settled;
                              got_votes[i] = count.voxels > 0;
                          }
                      });
    VoteCount count{voxels, flips, settled, {}};
    for (std::size_t i = 0; i < blocks.size(); ++i)
        if (got_votes[i]) count.blocks.push_back(blocks[i]);
    return count;
}

}  // namespace tessera
