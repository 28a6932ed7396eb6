// The map as an OpenVDB file, for Houdini, Blender and what else works on volumes. OpenVDB's
// headers are slow to compile: they stay in one source of a small library of its own, which is left
// out where OpenVDB is missing.
#pragma once

#include <string>

#include "core/status.h"
#include "mapping/block_map.h"

namespace tessera {

// Whether this build has OpenVDB; without, WriteVdb returns an error that says kVdbUnavailable.
bool VdbAvailable();
inline constexpr const char* kVdbUnavailable =
    "not in this build: install libopenvdb-dev and build again";

// Two grids in the map's world, in metres. Voxel (i, j, k) is centred at (i, j, k) * voxel size, as
// in the map.
//   surface  float, level set: the signed distance in metres, positive in free space; the
//   background
//            is the truncation distance. Active voxels are those that were measured and lie within
//            the truncation. What was never seen is background, so the band has a back side, too:
//            a mesh of the zero level is a shell as thick as the truncation.
//   Cd       vec3s: linear colour, 0 to 1, of the same voxels where they have one.
// The same map gives the same bytes. Takes about 8 KB of memory per block of the map. Written
// beside the target and renamed. Errors: writing, memory, no OpenVDB.
Status WriteVdb(const std::string& path, const BlockMap& map);

}  // namespace tessera
