#include "semantics/label_votes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace tessera {
namespace {

struct Voting {
    const LabelImage& labels;
    std::span<const Ballot> ballots;
    const DepthImage& depth_m;
    const PinholeCamera& camera;
    Eigen::Isometry3d T_camera_world;
    double band_m;

    Ballot BallotOf(std::uint8_t label) const {
        if (label == LabelImage::kBesideObjects) return {kBackgroundClass, 0};
        return ballots[label - 1u];
    }
};

// Blocks of the map around the labelled pixels' surface, each once, increasing.
std::vector<BlockId> BlocksOf(const Voting& v, const Eigen::Isometry3d& T_world_camera, const BlockMap& map) {
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
                const Eigen::Vector3d p = T_world_camera * v.camera.Unproject(x, y, v.depth_m(x, y)) / block_m;
                const Eigen::Array3i low = (p.array() - margin).floor().cast<int>();
                const Eigen::Array3i high = (p.array() + margin).floor().cast<int>();
                for (int bz = low.z(); bz <= high.z(); ++bz)
                    for (int by = low.y(); by <= high.y(); ++by)
                        for (int bx = low.x(); bx <= high.x(); ++bx) {
                            const BlockId id = map.Find({bx, by, bz});
                            if (id != kUnknownBlock && (blocks.empty() || blocks.back() != id)) blocks.push_back(id);
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

// The label of the pixel that sees the point, 0 if none does.
std::uint8_t LabelAt(const Voting& v, const Eigen::Vector3d& p_camera, double truncation_m) {
    if (p_camera.z() < 0.01) return 0;
    const Eigen::Vector2d pixel = v.camera.Project(p_camera);
    if (!(std::abs(pixel.x()) < 1e6) || !(std::abs(pixel.y()) < 1e6)) return 0;
    const int x = static_cast<int>(std::lround(pixel.x())), y = static_cast<int>(std::lround(pixel.y()));
    if (!v.depth_m.Contains(x, y)) return 0;
    const double z = v.depth_m(x, y);
    return z > 0 && std::abs(z - p_camera.z()) <= truncation_m ? v.labels.detection(x, y) : std::uint8_t{0};
}

VoteCount VoteInBlock(const Voting& v, BlockId id, BlockMap& map) {
    VoteCount count;
    const BlockCoord c = map.coord(id);
    const double voxel_m = map.config().voxel_size_m, truncation_m = map.config().truncation_m;
    const float band = static_cast<float>(v.band_m / truncation_m);
    const FieldWord* field = map.field(id);
    for (int i = 0; i < kBlockVoxels; ++i) {
        if (!HasDistance(field[i]) || std::abs(FieldDistance(field[i])) > band) continue;
        const Eigen::Vector3d voxel(8.0 * c.x + (i & 7), 8.0 * c.y + (i >> 3 & 7), 8.0 * c.z + (i >> 6));
        const std::uint8_t label = LabelAt(v, v.T_camera_world * (voxel * voxel_m), truncation_m);
        if (label == 0) continue;
        const Ballot ballot = v.BallotOf(label);
        if (ballot.class_id == 0) continue;
        VoxelLabel& voxel_label = map.label(id)[i];
        count.flips += VoteForClass(ballot.class_id, voxel_label);
        VoteForInstance(ballot.instance, voxel_label);
        ++count.voxels;
    }
    return count;
}

}  // namespace

VoteCount VoteLabels(const LabelImage& labels, std::span<const Ballot> ballots, const DepthImage& depth_m,
                     const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera, double band_m, BlockMap& map) {
    const Voting voting{labels, ballots, depth_m, camera, T_world_camera.inverse(), band_m};
    const std::vector<BlockId> blocks = BlocksOf(voting, T_world_camera, map);
    std::vector<std::uint8_t> got_votes(blocks.size());
    std::atomic<std::int64_t> voxels = 0, flips = 0;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks.size(), 16), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const VoteCount count = VoteInBlock(voting, blocks[i], map);
            voxels += count.voxels;
            flips += count.flips;
            got_votes[i] = count.voxels > 0;
        }
    });
    VoteCount count{voxels, flips, {}};
    for (std::size_t i = 0; i < blocks.size(); ++i)
        if (got_votes[i]) count.blocks.push_back(blocks[i]);
    return count;
}

}  // namespace tessera
