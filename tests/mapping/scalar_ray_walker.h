// Reference for the SIMD ray caster: the same ray walk in scalar float, one ray at a time.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mapping/field_sampler.h"
#include "mapping/ray_ranges.h"

namespace tessera::testing_support {

class ScalarRayWalker {
  public:
    struct Hit {
        float depth_m = 0;  // 0: no hit
        Eigen::Vector3f normal_camera = Eigen::Vector3f::Zero();
        float intensity = 0;  // only where all eight corners have one
        bool has_intensity = false;
    };

    ScalarRayWalker(const BlockMap& map, const PinholeCamera& camera,
                    const Eigen::Isometry3d& T_world_camera, float min_depth_m, float max_depth_m)
        : camera_(camera), sampler_(map.view(), OriginOf(map, T_world_camera)) {
        const double voxel_m = map.config().voxel_size_m;
        voxel_m_ = static_cast<float>(voxel_m);
        truncation_m_ = static_cast<float>(map.config().truncation_m);
        range_m_ = static_cast<float>(map.config().range_m());
        const BlockCoord origin = OriginOf(map, T_world_camera);
        start_ = (T_world_camera.translation() / voxel_m -
                  kBlockSide * Eigen::Vector3d(origin.x, origin.y, origin.z))
                     .cast<float>();
        voxel_from_camera_ = (T_world_camera.linear() / voxel_m).cast<float>();
        camera_from_world_ = T_world_camera.linear().transpose().cast<float>();
        ranges_.Build(map, camera, T_world_camera, min_depth_m, max_depth_m);
    }

    // The first front-facing surface along the ray of pixel (u, v).
    Hit Cast(int u, int v) {
        constexpr int kTile = kRayTilePx;
        const auto [first_m, last_m] =
            ranges_.ranges[static_cast<std::size_t>(v / kTile * ranges_.width + u / kTile)];
        step_ = voxel_from_camera_ * camera_.Unproject(u, v, 1).cast<float>();
        metres_per_voxel_ = 1 / step_.norm();
        bool has_front = false;
        float front_z = 0, front_m = 0, advance_voxels = 0;
        for (float z = first_m; z <= last_m; z += advance_voxels * metres_per_voxel_) {
            const FieldCell cell = CellAt(z);
            const Distance distance = DistanceAt(cell);
            if (!distance.known) {
                advance_voxels = cell.block == kUnknownBlock ? VoxelsToBlockEnd(cell) : 1.0f;
                has_front = false;
                continue;
            }
            if (distance.metres <= 0 && has_front) {
                const float zero_z = Refine(front_z, front_m, z, distance.metres);
                if (zero_z > 0) return HitAt(zero_z);
            }
            has_front = distance.metres > 0;
            front_z = z;
            front_m = distance.metres;
            advance_voxels = distance.step_voxels;
        }
        return {};
    }

  private:
    struct Distance {
        bool known;
        float metres, step_voxels;
    };

    static BlockCoord OriginOf(const BlockMap& map, const Eigen::Isometry3d& T_world_camera) {
        const Eigen::Vector3i block =
            (T_world_camera.translation() / (map.config().voxel_size_m * kBlockSide))
                .array()
                .floor()
                .cast<int>();
        return {block.x(), block.y(), block.z()};
    }

    FieldCell CellAt(float z) {
        const Eigen::Vector3f p = start_ + z * step_;
        return sampler_.Locate(p.x(), p.y(), p.z());
    }

    // The distance of the nearest voxel far from the surface, interpolated near the surface.
    Distance DistanceAt(const FieldCell& cell) const {
        const FieldWord word = sampler_.Nearest(cell);
        if (!HasDistance(word)) return {false, 0, 0};
        const float nearest_m = FieldDistance(word) * range_m_;
        if (std::abs(nearest_m) > 1.5f * voxel_m_)
            return {true, nearest_m, 0.8f * std::abs(nearest_m) / voxel_m_};
        const FieldSample sample = sampler_.Sample<false>(cell);
        return {sample.has_distance, sample.distance.value,
                std::abs(sample.distance.value) / voxel_m_ + 0.5f};
    }

    float VoxelsToBlockEnd(const FieldCell& cell) const {
        const Eigen::Vector3f into(static_cast<float>(cell.x) + cell.fx,
                                   static_cast<float>(cell.y) + cell.fy,
                                   static_cast<float>(cell.z) + cell.fz);
        float least_z = std::numeric_limits<float>::max();
        for (int i = 0; i < 3; ++i)
            if (step_[i] != 0)
                least_z =
                    std::min(least_z, ((step_[i] > 0 ? kBlockSide : 0.0f) - into[i]) / step_[i]);
        return std::max(least_z / metres_per_voxel_, 0.0f) + 1e-2f;
    }

    // Regula falsi with the Illinois rule. Returns 0 if there is no zero.
    float Refine(float a_z, float a_m, float b_z, float b_m) {
        if (a_m > 0.99f * truncation_m_ && b_m < -0.99f * truncation_m_) return 0;
        int last_side = 0;
        for (int i = 0; i < 12; ++i) {
            const float z = a_z + (b_z - a_z) * a_m / (a_m - b_m);
            const FieldSample sample = sampler_.Sample<false>(CellAt(z));
            if (!sample.has_distance) return 0;
            const float distance_m = sample.distance.value;
            if (std::abs(distance_m) < 1e-3f * voxel_m_) return z;
            const int side = distance_m > 0 ? 1 : -1;
            (side > 0 ? a_z : b_z) = z;
            (side > 0 ? a_m : b_m) = distance_m;
            if (last_side == side) (side > 0 ? b_m : a_m) /= 2;
            last_side = side;
        }
        return 0;
    }

    Hit HitAt(float z) {
        const FieldSample sample = sampler_.Sample<true>(CellAt(z));
        const auto& g = sample.distance;
        return {z, (camera_from_world_ * Eigen::Vector3f(g.gx, g.gy, g.gz)).normalized(),
                sample.intensity.value, sample.has_intensity};
    }

    PinholeCamera camera_;
    FieldSampler<BlockMapView> sampler_;
    RayRanges ranges_;
    Eigen::Vector3f start_, step_ = Eigen::Vector3f::Zero();
    Eigen::Matrix3f voxel_from_camera_, camera_from_world_;
    float voxel_m_ = 0, truncation_m_ = 0, range_m_ = 0, metres_per_voxel_ = 0;
};

}  // namespace tessera::testing_support
