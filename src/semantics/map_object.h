// An object found in the map, as it is saved and displayed, and its measurement on the labelled
// mesh.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "semantics/label_config.h"

namespace tessera {

// World frame of the run, metres.
struct MapObject {
    int id = 0;  // from 1, constant during the run; VertexLabel::instance
    int class_id = 0;
    std::string class_name;
    Rgb8 colour;             // of its class
    double probability = 0;  // mean over the detections of this class, times their share
    int observations = 0;    // number of detections
    std::int64_t vertices = 0;
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  // of its surface
    Eigen::AlignedBox3d box;
    // Centre and axes of the oriented box.
    Eigen::Isometry3d T_world_oriented = Eigen::Isometry3d::Identity();
    Eigen::Vector3d oriented_size = Eigen::Vector3d::Zero();
    std::vector<float> embedding;  // of length 1; empty if the detector gives none
};

// Fills centroid, boxes and vertex count of each object from the vertices with its number. Reads
// the mesh once, however many objects there are. The boxes leave out the outermost 0.5 % of the
// vertices on each side of each axis, because single voxels may be mislabelled.
void MeasureObjects(const TriangleMesh& mesh, std::span<MapObject> objects);

// Returns the text of objects.json: a list with one entry per object.
std::string ObjectsJson(const std::vector<MapObject>& objects);

}  // namespace tessera
