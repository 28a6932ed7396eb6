// A level world for exports: z up and the floor at z = 0, found in the mesh.
#pragma once

#include <vector>

#include "core/mesh.h"
#include "core/se3.h"
#include "core/status.h"

namespace tessera {

struct Level {
    // The level world's origin is below the first camera, whose view is along +y.
    Eigen::Isometry3d T_level_world = Eigen::Isometry3d::Identity();
    double tilt_rad = 0;     // between the first camera's up (-y) and the level world's z
    std::size_t points = 0;  // vertices of the surface that the level was taken from
    double roughness_m = 0;  // their RMS distance from its plane
};

// The largest horizontal surface that faces up (floor or table) or down (ceiling) gives the
// vertical; horizontal is what lies within 40 degrees of how the cameras were held on average:
// upright or, as a phone is, sideways. The floor is the lowest surface with a fifth of its size or
// more. Errors: no pose, cameras held in every direction, and meshes without a horizontal surface.
// Thread-safe.
Result<Level> FindLevel(const TriangleMesh& mesh, const std::vector<StampedPose>& path);

// Moves mesh and path into the level world.
void MakeLevel(const Level& level, TriangleMesh& mesh, std::vector<StampedPose>& path);

// From z up to y down and z ahead, which the glTF writer expects of a world.
TriangleMesh WithYDown(TriangleMesh mesh);

}  // namespace tessera
