// The maps of a scan for robots: floor plan, OctoMap and distance field, from one grid.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/se3.h"
#include "core/status.h"
#include "export/distance_field.h"
#include "export/occupancy.h"
#include "export/ros_map.h"
#include "mapping/block_map.h"

namespace tessera {

struct RobotMaps {
    // Output files; an empty path writes nothing.
    std::string ros_map;   // .yaml; an image .pgm beside it
    std::string octomap;   // .bt
    std::string distance;  // .npy; NAME_known.npy and NAME.yaml beside it

    double resolution_m = 0.05;
    // The box, metres in the level world. Default: everything that was mapped, 0.5 m more on each
    // side.
    std::optional<Eigen::AlignedBox3d> box_m;
    Occupancy::Options occupancy;
    RosMap::Options heights;
    DistanceField::Options distances;
};

// Checks what can be checked without a map, before anything is read: extensions, names that differ,
// resolution, heights and box. Errors name the option of `tessera maps`.
Status CheckRobotMaps(const RobotMaps& maps);

// Writes the files. `camera` and `path` (world frame) are those of the scan. `T_level_world` comes
// from FindLevel; the ROS map needs it, for the others it may be the identity, and then their frame
// is the world. `frame` names it in the distance field's file. Errors name the option or file: an
// empty map, a box that is too large, write errors. Thread-safe while nobody writes the map.
Status WriteRobotMaps(const RobotMaps& maps, const BlockMap& map, const PinholeCamera& camera,
                      const std::vector<StampedPose>& path, const Eigen::Isometry3d& T_level_world,
                      const std::string& frame);

}  // namespace tessera
