// What a run or a scan file holds of a scan: its mesh and the camera's path, in one world.
#pragma once

#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/status.h"
#include "io/trajectory.h"

namespace tessera {

struct Scanned {
    TriangleMesh mesh;
    std::vector<StampedPose> path;
};

// mesh.ply and trajectory.txt of a run's folder. Errors name the file.
Result<Scanned> ReadRunFolder(const std::string& folder);
// The same of a scan file; the mesh is made anew.
Result<Scanned> ReadScanFile(const std::string& path);
// FILE.scan, or a mesh file, which has no path.
Result<Scanned> ReadScanOrMesh(const std::string& path);

}  // namespace tessera
