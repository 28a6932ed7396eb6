// Frames of one depth and colour, and a visit to all voxels that a map knows.
#pragma once

#include "mapping/integrator.h"

namespace tessera {

inline Integrator::View At(const Eigen::Isometry3d& T_world_camera) {
    Integrator::View view;
    view.T_world_camera = T_world_camera;
    return view;
}

inline PreparedFrame Prepare(const Frame& frame) {
    PreparedFrame prepared;
    PrepareFrame(frame, {}, prepared);
    return prepared;
}

inline BlockMap::Config MapConfig(double voxel_m = 0.02, double truncation_m = 0.08) {
    BlockMap::Config config;
    config.voxel_size_m = voxel_m;
    config.truncation_m = truncation_m;
    return config;
}

inline Frame UniformFrame(const PinholeCamera& camera, float depth_m, Rgb8 colour) {
    Frame frame;
    frame.depth_m = DepthImage(camera.width, camera.height, depth_m);
    frame.colour = ColourImage(camera.width, camera.height, colour);
    return frame;
}

// Calls visit(point in metres, field word, weight word, colour word) for every voxel that has a
// distance.
template <class Visit>
void ForKnownVoxels(const BlockMap& map, const Visit& visit) {
    for (BlockId id = 1; id < map.size(); ++id) {
        const BlockCoord c = map.coord(id);
        for (int i = 0; i < kBlockVoxels; ++i) {
            if (!HasDistance(map.field(id)[i])) continue;
            const Eigen::Vector3d p =
                Eigen::Vector3d(c.x * 8 + (i & 7), c.y * 8 + (i >> 3 & 7), c.z * 8 + (i >> 6)) *
                map.config().voxel_size_m;
            visit(p, map.field(id)[i], map.weight(id)[i], map.colour(id)[i]);
        }
    }
}

}  // namespace tessera
