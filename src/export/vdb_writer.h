// Exports the map as an OpenVDB file, for Houdini, Blender and other volume software. OpenVDB's
// headers are slow to compile, so a single source in a small library of its own includes them. That
// library is a stub if OpenVDB is missing.
#pragma once

#include <string>

#include "core/status.h"
#include "mapping/block_map.h"

namespace tessera {

// Whether this build has OpenVDB. If not, WriteVdb returns an error that includes kVdbUnavailable.
bool VdbAvailable();
inline constexpr const char* kVdbUnavailable =
    "not in this build: install libopenvdb-dev and build again";

// Writes two grids in the map's world, in metres. Voxel (i, j, k) is centred at (i, j, k) * voxel
// size, as in the map.
//   surface  float, level set: the signed distance in metres, positive in free space. The
//            background is the truncation distance. Measured voxels within the truncation band
//            are active. Unobserved voxels are background, so the band has a back side, too:
//            a mesh of the zero level is a shell as thick as the truncation band.
//   Cd       vec3s: linear colour, 0 to 1, of the same voxels if they have one.
// The same map gives the same bytes. Takes about 8 KB of memory per block of the map. Writes to a
// temporary file and renames it. Errors: write errors, out of memory, no OpenVDB.
Status WriteVdb(const std::string& path, const BlockMap& map);

}  // namespace tessera
