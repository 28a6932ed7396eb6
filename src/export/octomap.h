// A 3D occupancy map as OctoMap's .bt file, which MoveIt, octomap_server and octovis read.
#pragma once

#include <string>

#include "core/status.h"
#include "export/occupancy.h"

namespace tessera {

// Writes an OcTree with occupied and free leaves in the grid's frame; eight equal leaves are merged
// into their parent. The grid's cells are OctoMap's leaves, so nothing is resampled. Unknown cells
// are absent. The same occupancy gives the same bytes. Errors: cells more than 32768 cells from the
// frame's origin (OctoMap's limit), out of memory, write errors. Thread-safe for different paths.
// Source: OctoMap 1.9, OcTreeBaseImpl and OccupancyOcTreeBase::writeBinaryData.
Status WriteOctomap(const std::string& path, const Occupancy& occupancy);

}  // namespace tessera
