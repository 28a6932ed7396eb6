#include "mapping/visible_blocks.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

// The camera's view as a cone of four planes through its centre, in the camera frame.
class Frustum {
  public:
    Frustum(const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera, double far_m)
        : camera_(camera), T_camera_world_(T_world_camera.inverse()), far_m_(far_m) {
        const double left = (-0.5 - camera.cx) / camera.fx, right = (camera.width - 0.5 - camera.cx) / camera.fx;
        const double top = (-0.5 - camera.cy) / camera.fy, bottom = (camera.height - 0.5 - camera.cy) / camera.fy;
        planes_[0] = Eigen::Vector3d(1, 0, -left).normalized();
        planes_[1] = Eigen::Vector3d(-1, 0, right).normalized();
        planes_[2] = Eigen::Vector3d(0, 1, -top).normalized();
        planes_[3] = Eigen::Vector3d(0, -1, bottom).normalized();
    }

    Eigen::Vector3d ToCamera(const Eigen::Vector3d& p_world) const { return T_camera_world_ * p_world; }

    bool MayContain(const Eigen::Vector3d& centre_camera, double radius_m) const {
        if (centre_camera.z() < -radius_m || centre_camera.z() > far_m_ + radius_m) return false;
        return std::all_of(std::begin(planes_), std::end(planes_),
                           [&](const Eigen::Vector3d& n) { return n.dot(centre_camera) > -radius_m; });
    }

  private:
    PinholeCamera camera_;
    Eigen::Isometry3d T_camera_world_;
    double far_m_;
    Eigen::Vector3d planes_[4];
};

// Whether a ball in the camera frame may hold voxels in front of, or just behind, what the tiles it covers measured.
bool MayChange(const DepthTiles& tiles, const PinholeCamera& camera, const Eigen::Vector3d& c, double radius_m,
               double truncation_m) {
    if (c.z() < 2 * radius_m) return true;  // too near to bound its image
    const double reach = radius_m / (c.z() - radius_m);  // bounds the ball's image, in units of focal lengths
    const double u = c.x() / c.z() * camera.fx + camera.cx, v = c.y() / c.z() * camera.fy + camera.cy;
    const double slant = 1.0 + std::hypot(c.x(), c.y()) / c.z();
    const double ru = reach * slant * camera.fx + 1, rv = reach * slant * camera.fy + 1;
    const auto tile = [](double pixel, int count) {
        return std::clamp(static_cast<int>(std::floor(pixel / DepthTiles::kTilePx)), 0, count - 1);
    };
    const double near_z = c.z() - radius_m - truncation_m;
    for (int ty = tile(v - rv, tiles.height); ty <= tile(v + rv, tiles.height); ++ty)
        for (int tx = tile(u - ru, tiles.width); tx <= tile(u + ru, tiles.width); ++tx)
            if (tiles.farthest_m[static_cast<std::size_t>(ty * tiles.width + tx)] > near_z) return true;
    return false;
}

}  // namespace

void DepthTiles::Build(const DepthImage& depth) {
    width = (depth.width() + kTilePx - 1) / kTilePx;
    height = (depth.height() + kTilePx - 1) / kTilePx;
    nearest_m.assign(static_cast<std::size_t>(width * height), 1e9f);
    farthest_m.assign(static_cast<std::size_t>(width * height), 0.0f);
    tbb::parallel_for(0, height, [&](int ty) {
        for (int y = ty * kTilePx; y < std::min(depth.height(), (ty + 1) * kTilePx); ++y) {
            for (int x = 0; x < depth.width(); ++x) {
                const float z = depth(x, y);
                const std::size_t tile = static_cast<std::size_t>(ty * width + x / kTilePx);
                farthest_m[tile] = std::max(farthest_m[tile], z);
                nearest_m[tile] = std::min(nearest_m[tile], z > 0 ? z : 1e9f);
            }
        }
    });
}

const std::vector<BlockId>& VisibleBlocks::Find(const BlockMap& map, const PinholeCamera& camera,
                                                const Eigen::Isometry3d& T_world_camera,
                                                const DepthImage& depth_m, float farthest_m) {
    tiles_.Build(depth_m);
    const double truncation_m = map.config().truncation_m;
    const double block_m = map.config().voxel_size_m * kBlockSide;
    const double region_m = block_m * BlockMap::kRegionBlocks;
    const double far_m = farthest_m + truncation_m;
    const Frustum frustum(camera, T_world_camera, far_m);

    // Regions in the box around the frustum.
    Eigen::Vector3d low = T_world_camera.translation(), high = low;
    for (const double u : {-0.5, camera.width - 0.5})
        for (const double v : {-0.5, camera.height - 0.5}) {
            const Eigen::Vector3d corner = T_world_camera * camera.Unproject(u, v, far_m);
            low = low.cwiseMin(corner);
            high = high.cwiseMax(corner);
        }
    const Eigen::Vector3i first = (low / region_m).array().floor().cast<int>() - 1;
    const Eigen::Vector3i last = (high / region_m).array().floor().cast<int>();
    candidates_.clear();
    for (int z = first.z(); z <= last.z(); ++z)
        for (int y = first.y(); y <= last.y(); ++y)
            for (int x = first.x(); x <= last.x(); ++x) {
                const Eigen::Vector3d centre = (Eigen::Vector3d(x, y, z).array() + 0.5) * region_m;
                if (!frustum.MayContain(frustum.ToCamera(centre), 0.8661 * region_m)) continue;
                const auto blocks = map.BlocksInRegion({x, y, z});
                candidates_.insert(candidates_.end(), blocks.begin(), blocks.end());
            }

    keep_.resize(candidates_.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, candidates_.size(), 512), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const BlockCoord b = map.coord(candidates_[i]);
            const Eigen::Vector3d centre =
                (Eigen::Vector3d(b.x, b.y, b.z) * kBlockSide + Eigen::Vector3d::Constant(3.5)) *
                map.config().voxel_size_m;
            const Eigen::Vector3d centre_camera = frustum.ToCamera(centre);
            const double radius_m = 3.5 * 1.7321 * map.config().voxel_size_m;
            keep_[i] = frustum.MayContain(centre_camera, radius_m) &&
                       MayChange(tiles_, camera, centre_camera, radius_m, truncation_m);
        }
    });
    visible_.clear();
    for (std::size_t i = 0; i < candidates_.size(); ++i)
        if (keep_[i]) visible_.push_back(candidates_[i]);
    std::sort(visible_.begin(), visible_.end());
    return visible_;
}

}  // namespace tessera
