// Moves joined parts of a map to where the pose graph has them, each as a whole, and removes those
// that are left out.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mapping/block_map.h"
#include "mapping/map_volume.h"
#include "optimize/scan_graph.h"

namespace tessera {

struct MovedParts {
    std::unique_ptr<BlockMap> map;
    std::vector<Eigen::Isometry3d> T_map_keyframe;  // with which it would have been made
    std::vector<BlockCoord> doubtful;               // WarpedMap
};

// What else has changed in the graph is left to the next correction. Where a surface lands on
// another, that one stays, as in a map that is moved. `box`: blocks outside it are dropped.
// `doubtful`: blocks of the map in use that are so already; they stay so, and move with their part.
MovedParts MoveParts(const BlockMap& in_use, const ScanGraph& graph, const WorldBox& box,
                     std::span<const BlockCoord> doubtful = {});

}  // namespace tessera
