// Walks in parts of a scan, and how right the path and the map are afterwards.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "mapping/field_sampler.h"
#include "optimize/room_walk.h"
#include "optimize/scan_parts.h"

namespace tessera::testing_support {

// A part of the scan: the camera's path is right, and begins at this place of the map.
inline void Walk(Walker& walker, const std::vector<Frame>& frames, int part) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
        Eigen::Isometry3d T_last_camera = Eigen::Isometry3d::Identity();
        if (i > 0)
            T_last_camera = frames[i - 1].T_world_camera->inverse() * *frames[i].T_world_camera;
        else
            walker.T_map_camera = PartStart(part);
        walker.Go(frames[i], T_last_camera);
    }
}

inline double FarthestFrom(const Eigen::Vector3d& p, const BlockMap& map) {
    double farthest_m = 0;
    for (BlockId id = 1; id < map.size(); ++id) {
        if (map.IsFree(id)) continue;
        const BlockCoord& c = map.coord(id);
        const double side_m = kBlockSide * map.config().voxel_size_m;
        farthest_m = std::max(farthest_m, (side_m * Eigen::Vector3d(c.x, c.y, c.z) - p).norm());
    }
    return farthest_m;
}

// Largest distance from the true path of these frames, both begun at the first pose.
inline double FarthestOff(const std::vector<StampedPose>& path, const std::vector<Frame>& frames) {
    double farthest_m = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const Eigen::Isometry3d T_first = path[0].T_world_camera.inverse() * path[i].T_world_camera,
                                T_first_true =
                                    frames[0].T_world_camera->inverse() * *frames[i].T_world_camera;
        farthest_m =
            std::max(farthest_m, (T_first.translation() - T_first_true.translation()).norm());
    }
    return farthest_m;
}

// How far the map's surface is, on average, from where a frame shows it from this pose. Infinite if
// less than nine tenths are known.
inline double MeanOff_m(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                        const Walker& walker) {
    const BlockMap& map = *walker.map;
    const PinholeCamera camera = RoomCamera();
    FieldSampler<BlockMapView> sampler(map.view(), {0, 0, 0});
    double sum_m = 0;
    int points = 0, known = 0;
    for (int y = 2; y < camera.height; y += 7)
        for (int x = 2; x < camera.width; x += 7) {
            const float z = frame.depth_m(x, y);
            if (z <= 0 || z > 3) continue;
            ++points;
            const Eigen::Vector3f p =
                (T_world_camera * camera.Unproject(x, y, z) / map.config().voxel_size_m)
                    .cast<float>();
            const FieldSample sample = sampler.Sample<false>(sampler.Locate(p.x(), p.y(), p.z()));
            if (!sample.has_distance) continue;
            ++known;
            sum_m += std::abs(sample.distance.value);
        }
    return known >= 0.9 * points ? sum_m / known : std::numeric_limits<double>::infinity();
}

// From its true pose.
inline double MeanOff_m(const Frame& frame, const Walker& walker) {
    return MeanOff_m(frame, *frame.T_world_camera, walker);
}

}  // namespace tessera::testing_support
