// An object found in the map, as it is written down and shown, and the measuring of it on the
// labelled mesh.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "semantics/label_config.h"

namespace tessera {

// All of the run's world frame, metres.
struct MapObject {
    int id = 0;  // the same during the whole run, from 1 on; VertexLabel::instance
    int class_id = 0;
    std::string class_name;
    Rgb8 colour;             // of its class
    double probability = 0;  // mean of the detections that gave this class, times their share
    int observations = 0;    // detections
    std::int64_t vertices = 0;
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  // of its surface's area
    Eigen::AlignedBox3d box;
    // The oriented box's centre and axes.
    Eigen::Isometry3d T_world_oriented = Eigen::Isometry3d::Identity();
    Eigen::Vector3d oriented_size = Eigen::Vector3d::Zero();
};

// Fills centroid, boxes and vertex count of the object `id` from the mesh's vertices with that
// instance. The half per cent of vertices that lie farthest out on each side of each axis are left
// out of the boxes: single voxels go astray.
void MeasureObject(const TriangleMesh& mesh, MapObject& object);

// The file objects.json: a list, one entry an object.
std::string ObjectsJson(const std::vector<MapObject>& objects);

}  // namespace tessera
