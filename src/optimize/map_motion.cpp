#include "optimize/map_motion.h"

#include <algorithm>
#include <cmath>

#include "mapping/visible_blocks.h"
#include "optimize/camera_view.h"

namespace tessera {
namespace {

struct MotionSum {
    double weight = 0, square_m2 = 0, surface_weight = 0;
    Eigen::Vector3d shift_m = Eigen::Vector3d::Zero(), surface_shift_m = shift_m;
};

struct KeyframeView {
    PinholeCamera camera;
    DepthImage depth_m;
    float farthest_m = 0;

    // A surface is measured within this distance of a point of the camera's, along its ray.
    bool MeasuresNear(const Eigen::Vector3d& p_camera, double distance_m) const {
        if (p_camera.z() <= 0) return false;
        const Eigen::Vector2d pixel = camera.Project(p_camera);
        const double u = std::round(pixel.x()), v = std::round(pixel.y());
        return u >= 0 && v >= 0 && u < depth_m.width() && v < depth_m.height() &&
               std::abs(depth_m(static_cast<int>(u), static_cast<int>(v)) - p_camera.z()) <=
                   distance_m;
    }
};

// The reduced view of a keyframe has no depth at edges. Old scan files have only the coarse one.
KeyframeView DepthSeenBy(const Keyframe& keyframe, const PinholeCamera& camera) {
    KeyframeView view;
    const ReducedView& reduced = keyframe.reduced;
    if (reduced.empty()) {
        view.camera = keyframe.view;
        view.depth_m = keyframe.depth_m;
    } else {
        view.camera = Averaged(camera, reduced.reduction);
        view.depth_m.Resize(reduced.depth.width(), reduced.depth.height());
        std::transform(reduced.depth.data(), reduced.depth.data() + reduced.depth.size(),
                       view.depth_m.data(), [](std::uint16_t units) {
                           return static_cast<float>(units) / ReducedView::kUnitsPerM;
                       });
    }
    for (std::size_t i = 0; i < view.depth_m.size(); ++i)
        view.farthest_m = std::max(view.farthest_m, view.depth_m.data()[i]);
    return view;
}

Eigen::Vector3d CentreOf(const BlockCoord& c, double voxel_m) {
    return voxel_m * (kBlockSide * Eigen::Vector3d(c.x, c.y, c.z) +
                      Eigen::Vector3d::Constant(0.5 * (kBlockSide - 1)));
}

// Blocks that only frames between the keyframes saw move like the blocks beside them.
void FillUnseen(const BlockMap& map, std::vector<BlockMotion>& motions) {
    std::vector<std::pair<BlockId, BlockMotion>> filled;
    for (BlockId id = 1; id < map.size(); ++id) {
        if (map.IsFree(id) || motions[static_cast<std::size_t>(id)].seen) continue;
        BlockMotion mean;
        int count = 0;
        for (int i = 0; i < 27; ++i) {
            const BlockId beside = map.neighbour(id, i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
            const BlockMotion& motion = motions[static_cast<std::size_t>(beside)];
            if (!motion.seen) continue;
            mean.shift_m += motion.shift_m;
            mean.spread_m += motion.spread_m;
            ++count;
        }
        if (count == 0) continue;
        filled.push_back({id,
                          {mean.shift_m / static_cast<float>(count),
                           mean.spread_m / static_cast<float>(count), true}});
    }
    for (const auto& [id, motion] : filled) motions[static_cast<std::size_t>(id)] = motion;
}

}  // namespace

std::vector<BlockMotion> MotionOfBlocks(const BlockMap& map, const Keyframes& keyframes,
                                        const std::vector<Eigen::Isometry3d>& T_new_keyframe,
                                        const PinholeCamera& camera) {
    constexpr double kNearest_m = 0.3;
    const double voxel_m = map.config().voxel_size_m,
                 radius_m = 0.5 * std::sqrt(3.0) * kBlockSide * voxel_m;
    const TruncationBand band = map.config().band();
    std::vector<MotionSum> sums(static_cast<std::size_t>(map.size()));
    VisibleBlocks visible;
    for (int k = 0; k < keyframes.size(); ++k) {
        const Eigen::Isometry3d& T_old = keyframes[k].T_map_camera;
        const Eigen::Isometry3d T_old_inverse = T_old.inverse();
        const Eigen::Isometry3d& T_new = T_new_keyframe[static_cast<std::size_t>(k)];
        const KeyframeView view = DepthSeenBy(keyframes[k], camera);
        if (view.farthest_m == 0) continue;
        for (const BlockId id :
             visible.Find(map, view.camera, T_old, view.depth_m, view.farthest_m)) {
            const Eigen::Vector3d centre = CentreOf(map.coord(id), voxel_m),
                                  p_camera = T_old_inverse * centre,
                                  shift_m = T_new * p_camera - centre;
            const double z = std::max(p_camera.z(), kNearest_m), weight = 1 / (z * z);
            MotionSum& sum = sums[static_cast<std::size_t>(id)];
            sum.weight += weight;
            sum.shift_m += weight * shift_m;
            sum.square_m2 += weight * shift_m.squaredNorm();
            if (!view.MeasuresNear(p_camera, radius_m + band.At(static_cast<float>(z)))) continue;
            sum.surface_weight += weight;
            sum.surface_shift_m += weight * shift_m;
        }
    }
    std::vector<BlockMotion> motions(sums.size());
    for (std::size_t i = 1; i < sums.size(); ++i) {
        const MotionSum& sum = sums[i];
        if (sum.weight == 0) continue;
        const Eigen::Vector3d mean = sum.shift_m / sum.weight,
                              shift_m = sum.surface_weight > 0
                                            ? sum.surface_shift_m / sum.surface_weight
                                            : mean;
        const double variance = sum.square_m2 / sum.weight - mean.squaredNorm();
        motions[i] = {shift_m.cast<float>(), static_cast<float>(std::sqrt(std::max(0.0, variance))),
                      true};
    }
    FillUnseen(map, motions);
    return motions;
}

}  // namespace tessera
